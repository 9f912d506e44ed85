// SPDX-License-Identifier: GPL-3.0-or-later
// Exercise 3 with its scripted motions: the good one in each shipped case, and each mistake.
#include "tests/exercises/play_motion.h"
#include "tests/exercises/told_hints.h"

namespace insula {
namespace {

const std::filesystem::path scenes = std::filesystem::path(INSULA_SOURCE_DIR) / "scenes";
const std::filesystem::path clipping_scene = scenes / "training/3_clipping.xml";

class ShippedCase : public testing::TestWithParam<const char*> {};
INSTANTIATE_TEST_SUITE_P(Clipping, ShippedCase,
                         testing::Values("training/3_clipping.xml", "cases/clipping_narrow_neck.xml"),
                         [](const auto& one) { return std::filesystem::path(one.param).stem().string(); });

TEST_P(ShippedCase, AnAngledClipClosesTheNeckAndSparesTheBranches) {
  test::ToldHints told;
  test::Played o = test::play_motion(scenes / GetParam(), "steady", -1, told.listener());
  ASSERT_TRUE(o.ran);
  told.expect_few();
  EXPECT_TRUE(o.finite);
  EXPECT_EQ(o.state, ExerciseState::done);
  EXPECT_GT(o.goals["clip"], 5);
  EXPECT_EQ(o.events["clip_loaded"], 1);
  EXPECT_EQ(o.events["clip_released"], 1);
  EXPECT_EQ(o.events["rupture"], 0);
  test::expect_well_clipped(o);
  test::expect_gentle(o);
  EXPECT_GT(o.measures["tip_past_neck"], 0.2);
  EXPECT_LT(o.measures["slit"], 1.0);
  EXPECT_LT(o.channels["heart.sac.pressure"], 1000) << "Pa: the dome is soft";
  EXPECT_LT(o.channels["heart.sac.volume_share"], 0.6) << "the dome has shrunk";
  EXPECT_GT(o.channels["heart.superior.volume_share"], 0.95) << "a branch has not";
}

TEST(Clipping, AClipAcrossABranchIsAFault) {
  test::ToldHints told;
  test::Played o = test::play_motion(clipping_scene, "careless", -1, told.listener());
  ASSERT_TRUE(o.ran);
  for (const char* rule : {"brain_force", "vessel_force", "rupture", "stenosis"})
    EXPECT_TRUE(told.first_fault.contains(rule)) << rule;
  EXPECT_GE(told.expect_told(), 1);
  EXPECT_TRUE(o.finite);
  EXPECT_EQ(o.state, ExerciseState::running);
  EXPECT_LT(o.goals["clip"], 0);
  EXPECT_EQ(o.faults["stenosis"], 1);
  EXPECT_LT(o.measures["inferior.flow_pct"], 50);
  EXPECT_GT(o.measures["inferior.stenosis_pct"], 50);
}

TEST(Clipping, AClipTooHighLeavesARemnant) {
  test::Played o = test::play_motion(clipping_scene, "too_high");
  ASSERT_TRUE(o.ran);
  EXPECT_LT(o.goals["clip"], 0);
  EXPECT_GE(o.measures["grade"], 2);
  EXPECT_GT(o.measures["remnant_pct"], 50);
  EXPECT_GT(o.measures["superior.flow_pct"], 90);
  EXPECT_GT(o.measures["inferior.flow_pct"], 90);
}

TEST(Clipping, AClipTooShortLetsBloodIn) {
  test::Played o = test::play_motion(clipping_scene, "too_short");
  ASSERT_TRUE(o.ran);
  EXPECT_LT(o.goals["clip"], 0);
  EXPECT_EQ(o.measures["grade"], 5);
  EXPECT_LT(o.measures["tip_past_neck"], 0);
}

TEST(Clipping, AShortClipMovedAlongTheNeckClosesIt) {
  test::Played o = test::play_motion(clipping_scene, "replaced");
  ASSERT_TRUE(o.ran);
  EXPECT_EQ(o.state, ExerciseState::done);
  EXPECT_EQ(o.events["clip_taken"], 1);
  EXPECT_EQ(o.measures["applications"], 2);
  test::expect_well_clipped(o);
  test::expect_gentle(o);
}

TEST(Clipping, ASecondClipBesideAShortOneLeavesLessOfTheNeck) {
  test::Played one = test::play_motion(clipping_scene, "too_short");
  test::Played both = test::play_motion(clipping_scene, "second");
  ASSERT_TRUE(one.ran && both.ran);
  EXPECT_EQ(both.measures["applications"], 2);
  EXPECT_GT(one.measures["remnant_pct"], 50);
  EXPECT_LT(both.measures["remnant_pct"], 0.6 * one.measures["remnant_pct"]);
  EXPECT_LE(both.measures["grade"], 1);
  EXPECT_EQ(both.state, ExerciseState::done) << "grade 1 passes";
  test::expect_no_harm(both);
}

TEST(Clipping, AFenestratedClipClosesTheNeckAroundABranch) {
  test::Played o = test::play_motion(clipping_scene, "branch_in_window");
  ASSERT_TRUE(o.ran);
  EXPECT_EQ(o.state, ExerciseState::done);
  EXPECT_EQ(o.measures["applications"], 1);
  EXPECT_LT(o.measures["inferior.stenosis_pct"], 20) << "the branch in the window is pinched";
  test::expect_well_clipped(o);
  test::expect_gentle(o);
}

TEST(Clipping, AShutClipThatIsPulledSlipsOff) {
  test::ToldHints told;
  test::Played o = test::play_motion(clipping_scene, "slipping", -1, told.listener());
  ASSERT_TRUE(o.ran);
  EXPECT_GE(told.expect_told(), 1);
  ASSERT_TRUE(told.first_cue.contains("vessel_hint"));
  EXPECT_LE(told.first_cue["vessel_hint"], told.first_fault["slipped"] - 0.5) << "the pull on the vessel tells";
  EXPECT_LT(o.goals["clip"], 0);
  EXPECT_EQ(o.faults["slipped"], 1);
  EXPECT_EQ(o.events["clip_released"], 0);
}

// The clip presses the brain aside on its way, which is told first. The perforator is within the pause of that hint.
TEST(Clipping, ATurnedClipClosesOnAPerforator) {
  test::ToldHints told;
  test::Played o = test::play_motion(clipping_scene, "perforator_caught", -1, told.listener());
  ASSERT_TRUE(o.ran);
  told.expect_told();
  EXPECT_LT(o.goals["clip"], 0);
  EXPECT_EQ(o.events["perforator_shut"], 1);
  EXPECT_EQ(o.faults["perforator_shut"], 1);
}

}  // namespace
}  // namespace insula
