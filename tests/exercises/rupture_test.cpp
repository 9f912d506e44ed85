// SPDX-License-Identifier: GPL-3.0-or-later
// Exercise 4 with both scripted motions.
#include "tests/exercises/play_motion.h"

namespace insula {
namespace {

const std::filesystem::path rupture_scene = std::filesystem::path(INSULA_SOURCE_DIR) / "scenes/training/4_rupture.xml";

TEST(Rupture, MasteredWithTemporaryAndFinalClip) {
  test::Played o = test::play_motion(rupture_scene, "steady");
  ASSERT_TRUE(o.ran);
  EXPECT_TRUE(o.finite);
  EXPECT_EQ(o.state, ExerciseState::done);
  EXPECT_EQ(o.events["rupture"], 1);
  EXPECT_EQ(o.events["clip_released"], 2);
  EXPECT_EQ(o.events["clip_taken"], 1);
  EXPECT_GT(o.goals["stop"], 0);
  EXPECT_GT(o.goals["together"], 0);
  EXPECT_GT(o.goals["removed"], o.goals["stop"] - 1e-9);
  EXPECT_GT(o.longest["occlusion"], 5);
  EXPECT_LT(o.longest["occlusion"], 180);
  EXPECT_LT(o.longest["since_rupture"], 300);
  test::expect_well_clipped(o);
  EXPECT_GT(o.measures["tip_past_neck"], 0.1);
  EXPECT_GT(o.min_pressure, -40) << "Pa: the torn sac that a clip cuts off comes to the pressure outside";
}

TEST(Rupture, OneHandAloneDoesNotMasterIt) {
  test::Played o = test::play_motion(rupture_scene, "steady", 1);
  ASSERT_TRUE(o.ran);
  EXPECT_GT(o.goals["stop"], 0) << "the clips stop the bleeding all the same";
  EXPECT_LT(o.goals["together"], 0) << "nobody sucked while a clip closed";
  EXPECT_EQ(o.state, ExerciseState::running);
}

TEST(Rupture, TimeRunsOutWhenNobodyClips) {
  test::Played o = test::play_motion(rupture_scene, "late");
  ASSERT_TRUE(o.ran);
  EXPECT_TRUE(o.finite);
  EXPECT_EQ(o.state, ExerciseState::failed);
  EXPECT_NEAR(o.end, 301, 0.1);
  EXPECT_LT(o.goals["stop"], 0);
  EXPECT_NEAR(o.longest["since_rupture"], 300, 1);  // the clock goes on until the motion ends
}

}  // namespace
}  // namespace insula
