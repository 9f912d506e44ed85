// SPDX-License-Identifier: GPL-3.0-or-later
// Generated arteries are brought into the shipped fissure without overlap, or the author is told that they have no
// place.
#include "tools/case_builder/place.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "core/base/input_error.h"
#include "core/testing/block_mesh.h"
#include "tools/artery/generated_artery_for_test.h"
#include "tools/case_builder/project.h"
#include "tools/case_builder/wall.h"

namespace insula::case_builder {
namespace {

class Placed : public testing::TestWithParam<std::string> {
 protected:
  insula::test::SceneFolder folder;
  CaseFolder made{folder.path() / "case", "case"};
  Progress quiet;
  void place(const std::string& name) {
    const std::vector<artery::test::GeneratedArtery> all = artery::test::generated_arteries();
    const auto it = std::find_if(all.begin(), all.end(), [&](const auto& a) { return a.name == name; });
    ASSERT_NE(it, all.end());
    std::vector<Note> notes;
    artery::write_vessel(make_wall(it->surface(), {}, notes, quiet), made.wall());
    run_place(made, find_project(INSULA_SOURCE_DIR), {}, quiet);
  }
};

TEST_P(Placed, OverlapsNothing) {
  place(GetParam());
  for (const Json& r : read_json(made.path / "place.json").at("rooms"))
    EXPECT_GT(r.at("after_mm").get<double>(), 0.2) << r.at("what");
  EXPECT_EQ(artery::quality(read_wall(made.artery()).wall.mesh).euler, 2);
}

std::vector<std::string> that_fit() {
  std::vector<std::string> out;
  for (const artery::test::GeneratedArtery& a : artery::test::generated_arteries())
    if (!a.name.starts_with("giant")) out.push_back(a.name);
  return out;
}
INSTANTIATE_TEST_SUITE_P(Generated, Placed, testing::ValuesIn(that_fit()), [](const auto& p) { return p.param; });

using NoPlace = Placed;
TEST_F(NoPlace, AGiantDomeIsRefusedAndNoMeshIsWritten) {
  try {
    place("giant_side");
    FAIL();
  } catch (const InputError& e) {
    EXPECT_NE(std::string(e.what()).find("has no place in this fissure"), std::string::npos) << e.what();
  }
  EXPECT_FALSE(fs::exists(made.lobes()));
  EXPECT_FALSE(fs::exists(made.path / "place.json"));
}

}  // namespace
}  // namespace insula::case_builder
