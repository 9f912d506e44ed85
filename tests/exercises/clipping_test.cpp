// SPDX-License-Identifier: GPL-3.0-or-later
// Exercise 3 with both scripted motions.
#include "tests/exercises/play_motion.h"

namespace insula {
namespace {

const std::filesystem::path clipping_scene =
    std::filesystem::path(INSULA_SOURCE_DIR) / "scenes/training/3_clipping.xml";

TEST(Clipping, AnAngledClipClosesTheNeckAndSparesTheBranches) {
  test::Played o = test::play_motion(clipping_scene, "steady");
  ASSERT_TRUE(o.ran);
  EXPECT_TRUE(o.finite);
  EXPECT_EQ(o.state, ExerciseState::done);
  EXPECT_GT(o.goals["clip"], 5);
  EXPECT_EQ(o.events["clip_loaded"], 1);
  EXPECT_EQ(o.events["clip_released"], 1);
  EXPECT_EQ(o.events["rupture"], 0);
  for (const auto& [id, count] : o.faults) EXPECT_EQ(count, 0) << id;
  EXPECT_LE(o.measures["grade"], 2);
  EXPECT_GT(o.measures["superior.flow_pct"], 90);
  EXPECT_GT(o.measures["inferior.flow_pct"], 90);
  EXPECT_LT(o.measures["slit"], 1.0);
}

TEST(Clipping, AClipAcrossABranchIsAFault) {
  test::Played o = test::play_motion(clipping_scene, "careless");
  ASSERT_TRUE(o.ran);
  EXPECT_TRUE(o.finite);
  EXPECT_EQ(o.state, ExerciseState::running);
  EXPECT_LT(o.goals["clip"], 0);
  EXPECT_EQ(o.faults["stenosis"], 1);
  EXPECT_LT(o.measures["inferior.flow_pct"], 50);
  EXPECT_GT(o.measures["inferior.stenosis_pct"], 50);
}

}  // namespace
}  // namespace insula
