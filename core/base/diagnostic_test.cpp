// SPDX-License-Identifier: GPL-3.0-or-later
// Collecting, ordering and printing messages; suggestions.
#include "core/base/diagnostic.h"

#include <gtest/gtest.h>

namespace insula {
namespace {

TEST(Diagnostics, PrintsPlaceSeverityAndText) {
  Diagnostics d;
  EXPECT_TRUE(d.ok());
  d.error({"a.xml", 4, 38}, "wrong");
  d.warning({"a.xml", 0, 0}, "odd");
  d.error({"", 0, 0}, "nowhere");
  EXPECT_FALSE(d.ok());
  EXPECT_EQ(d.errors(), 2);
  EXPECT_EQ(d.format(), "a.xml:4:38: error: wrong\na.xml: warning: odd\nerror: nowhere\n");
}

TEST(Diagnostics, SameLineOnlyOnce) {
  Diagnostics d;
  d.error({"a.xml", 1, 1}, "wrong");
  d.error({"a.xml", 1, 1}, "wrong");
  EXPECT_EQ(d.format(), "a.xml:1:1: error: wrong\n");
  EXPECT_EQ(d.errors(), 2);
}

TEST(Diagnostics, SortsByFileAsMetThenLineThenColumn) {
  Diagnostics d;
  d.error({"z.xml", 9, 1}, "1");
  d.error({"a.xml", 1, 1}, "2");
  d.error({"z.xml", 2, 7}, "3");
  d.error({"z.xml", 2, 3}, "4");
  d.error({"z.xml", 2, 3}, "5");
  d.sort_by_position();
  EXPECT_EQ(
      d.format(),
      "z.xml:2:3: error: 4\nz.xml:2:3: error: 5\nz.xml:2:7: error: 3\nz.xml:9:1: error: 1\na.xml:1:1: error: 2\n");
  EXPECT_EQ(d.errors(), 5);
}

TEST(NearestName, FindsTypos) {
  const std::vector<std::string> names{"systolic", "diastolic", "young", "mesh", "mesh_unit"};
  EXPECT_EQ(nearest_name("sistolic", names), "systolic");
  EXPECT_EQ(nearest_name("yuong", names), "young");
  EXPECT_EQ(nearest_name("Young", names), "young");
  EXPECT_EQ(nearest_name("meshunit", names), "mesh_unit");
  EXPECT_EQ(nearest_name("diastolc", names), "diastolic");
}

TEST(NearestName, SuggestsNothingFarFetched) {
  const std::vector<std::string> names{"systolic", "young", "x"};
  EXPECT_EQ(nearest_name("viscosity", names), "");
  EXPECT_EQ(nearest_name("", names), "");
  EXPECT_EQ(nearest_name("y", names), "");
  EXPECT_EQ(nearest_name(std::string(100'000, 'a'), names), "");
  EXPECT_EQ(nearest_name("young", {}), "");
}

TEST(ProposedName, IsReadBackFromAMessage) {
  EXPECT_EQ(proposed_name("no \"yuong\"" + did_you_mean("young")), "young");
  EXPECT_EQ(proposed_name("no <clp>" + did_you_mean_element("clip")), "clip");
  EXPECT_EQ(proposed_name("no \"a\"" + did_you_mean("ab") + " (use one of ab, cd)"), "ab");
  EXPECT_EQ(proposed_name("no \"a\"" + did_you_mean("")), "");
  EXPECT_EQ(proposed_name(""), "");
}

}  // namespace
}  // namespace insula
