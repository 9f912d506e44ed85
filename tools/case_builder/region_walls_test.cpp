// SPDX-License-Identifier: GPL-3.0-or-later
// Thickness and stiffness by region: what is proposed, what an author changes, and what is refused.
#include "tools/case_builder/region_walls.h"

#include <gtest/gtest.h>

#include "core/base/input_error.h"

namespace insula::case_builder {
namespace {

artery::Vessel vessel() {
  artery::Vessel v;
  v.regions = {"parent", "branch_1", "neck", "sac", "bleb"};
  v.dimensions["sac_width"] = 5.6;
  return v;
}

std::vector<WallOf> walls(std::vector<std::string> changes) {
  Options o;
  o.walls = std::move(changes);
  return walls_of(vessel(), o);
}

std::string refusal(const std::string& change) {
  try {
    walls({change});
  } catch (const InputError& e) {
    return e.what();
  }
  return "";
}

TEST(RegionWalls, AreProposedForTheSizeOfTheSac) {
  const std::vector<WallOf> w = walls({});
  ASSERT_EQ(w.size(), 4u);
  EXPECT_EQ(w[0].regions, "parent branch_1");
  EXPECT_EQ(w[2].regions, "sac");
  EXPECT_DOUBLE_EQ(w[2].thickness_mm, 0.2);
  EXPECT_DOUBLE_EQ(w[2].young_mpa, 1.05);
}

TEST(RegionWalls, AChangeTouchesOnlyWhatItNames) {
  const std::vector<WallOf> before = walls({}), w = walls({"neck.young=7 MPa", "bleb.thickness=60 um"});
  ASSERT_EQ(w.size(), before.size());
  for (std::size_t k = 0; k < w.size(); ++k) {
    EXPECT_EQ(w[k].regions, before[k].regions);
    EXPECT_DOUBLE_EQ(w[k].young_mpa, w[k].regions == "neck" ? 7 : before[k].young_mpa);
    EXPECT_DOUBLE_EQ(w[k].thickness_mm, w[k].regions == "bleb" ? 0.06 : before[k].thickness_mm);
  }
}

TEST(RegionWalls, OneVesselLeavesTheOthersAndTheLastWordCounts) {
  const std::vector<WallOf> w = walls({"vessels.thickness=0.4 mm", "branch_1.young=3 MPa", "branch_1.young=2 MPa"});
  ASSERT_EQ(w.size(), 5u);
  EXPECT_EQ(w[0].regions, "parent");
  EXPECT_DOUBLE_EQ(w[0].young_mpa, 1.5);
  EXPECT_EQ(w[1].regions, "branch_1");
  EXPECT_DOUBLE_EQ(w[1].young_mpa, 2);
  for (const int k : {0, 1}) EXPECT_DOUBLE_EQ(w[std::size_t(k)].thickness_mm, 0.4);
  EXPECT_DOUBLE_EQ(w[2].thickness_mm, 0.25);
}

TEST(RegionWalls, ComeBackFromTheirJson) {
  const std::vector<WallOf> w = walls({"sac.young=2 MPa"}), again = walls_from(to_json(w));
  ASSERT_EQ(again.size(), w.size());
  for (std::size_t k = 0; k < w.size(); ++k) {
    EXPECT_EQ(again[k].regions, w[k].regions);
    EXPECT_EQ(again[k].young_mpa, w[k].young_mpa);
  }
}

TEST(RegionWalls, WrongOnesAreRefusedInWords) {
  EXPECT_NE(refusal("nek.young=7 MPa").find("did you mean \"neck\"?"), std::string::npos) << refusal("nek.young=7 MPa");
  EXPECT_NE(refusal("nek.young=7 MPa").find("it has vessels, parent, branch_1, neck, sac, bleb"), std::string::npos);
  EXPECT_NE(refusal("neck.young=7").find("MPa"), std::string::npos) << refusal("neck.young=7");
  EXPECT_NE(refusal("neck.young=7 mm").find("unit of pressure"), std::string::npos) << refusal("neck.young=7 mm");
  EXPECT_NE(refusal("neck.thickness=2 cm").find("outside the allowed range"), std::string::npos);
  EXPECT_NE(refusal("neck.poisson=0.4").find("thickness and young"), std::string::npos);
  EXPECT_NE(refusal("neck").find("REGION.PARAMETER=VALUE"), std::string::npos);
}

}  // namespace
}  // namespace insula::case_builder
