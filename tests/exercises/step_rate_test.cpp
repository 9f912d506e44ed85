// SPDX-License-Identifier: GPL-3.0-or-later
// What an exercise says of a scripted operation does not hang on how many steps the engine makes in a second.
#include "tests/exercises/play_motion.h"

namespace insula {
namespace {

class AtTwiceTheRate : public testing::TestWithParam<const char*> {};
INSTANTIATE_TEST_SUITE_P(Exercises, AtTwiceTheRate,
                         testing::Values("1_sylvian_fissure", "2_aneurysm_dissection", "3_clipping"),
                         [](const auto& one) { return std::string("Exercise") + one.param[0]; });

TEST_P(AtTwiceTheRate, TheGoodMotionReachesItsGoalsWithoutFaults) {
  const auto scene = std::filesystem::path(INSULA_SOURCE_DIR) / "scenes/training" / (std::string(GetParam()) + ".xml");
  const test::Played o = test::play_motion(scene, "steady", -1, {}, 1.0 / 120);
  ASSERT_TRUE(o.ran);
  EXPECT_TRUE(o.finite);
  EXPECT_EQ(o.state, ExerciseState::done);
  for (const auto& [id, time] : o.goals) EXPECT_GT(time, 0) << id;
  for (const auto& [id, count] : o.faults) EXPECT_EQ(count, 0) << id;
  EXPECT_FALSE(o.lasting_force.empty());
  for (const auto& [id, share] : o.lasting_force) EXPECT_LT(share, 0.6) << id;
}

}  // namespace
}  // namespace insula
