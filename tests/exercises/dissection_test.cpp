// SPDX-License-Identifier: GPL-3.0-or-later
// Exercise 2 with both scripted motions.
#include "tests/exercises/play_motion.h"

namespace insula {
namespace {

const std::filesystem::path dissection_scene =
    std::filesystem::path(INSULA_SOURCE_DIR) / "scenes/training/2_aneurysm_dissection.xml";

TEST(AneurysmDissection, SteadyHandsDivideTheStrandsWithoutAFault) {
  test::Played o = test::play_motion(dissection_scene, "steady");
  ASSERT_TRUE(o.ran);
  EXPECT_TRUE(o.finite);
  EXPECT_GE(o.strands, 30);
  EXPECT_LE(o.strands, 60);
  EXPECT_EQ(o.left, 0);
  EXPECT_EQ(o.events["strand_cut"], o.strands);
  EXPECT_EQ(o.events["strand_torn"], 0);
  ASSERT_EQ(o.faults.size(), 5u);
  for (const auto& [id, count] : o.faults) EXPECT_EQ(count, 0) << id;
  ASSERT_EQ(o.goals.size(), 1u);
  EXPECT_GT(o.goals["divide"], 0);
  EXPECT_EQ(o.state, ExerciseState::done);
  EXPECT_LT(o.max_force[1], 0.12) << "the dissector leans on something";
}

TEST(AneurysmDissection, RoughHandsTearPressAndRupture) {
  test::Played o = test::play_motion(dissection_scene, "rough");
  ASSERT_TRUE(o.ran);
  EXPECT_TRUE(o.finite);
  EXPECT_GE(o.faults["torn"], 1);
  EXPECT_GE(o.faults["vessel_force"], 1);
  EXPECT_GE(o.faults["brain_force"], 1);
  EXPECT_EQ(o.faults["rupture"], 1);
  EXPECT_EQ(o.events["rupture"], 1);
  EXPECT_EQ(o.state, ExerciseState::failed);
  EXPECT_GT(o.left, 0);
  EXPECT_LT(o.goals["divide"], 0);
}

}  // namespace
}  // namespace insula
