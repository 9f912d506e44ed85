// SPDX-License-Identifier: GPL-3.0-or-later
// The skill tasks with both scripted motions: a good one completes each of them, at both rates of the engine, and a
// beginner's earns the faults that it should.
#include <unistd.h>

#include <cstdlib>

#include "core/model/formats/file_bytes.h"
#include "tests/exercises/play_motion.h"

namespace insula {
namespace {

std::filesystem::path skill(const std::string& name) {
  return std::filesystem::path(INSULA_SOURCE_DIR) / "scenes/skills" / (name + ".xml");
}

class SkillTask : public testing::TestWithParam<std::tuple<const char*, int>> {};
INSTANTIATE_TEST_SUITE_P(Skills, SkillTask,
                         testing::Combine(testing::Values("1_touch_targets", "2_hold_a_force", "3_exchange",
                                                          "4_cut_threads", "5_clip_a_tube", "6_suction_a_pool"),
                                          testing::Values(60, 120)),
                         [](const auto& one) {
                           return "Skill" + std::string(std::get<0>(one.param)) + "_at_" +
                                  std::to_string(std::get<1>(one.param)) + "_Hz";
                         });

TEST_P(SkillTask, SteadyHandsCompleteItWithoutAFault) {
  const auto [name, rate] = GetParam();
  const test::Played o = test::play_motion(skill(name), "steady", -1, {}, 1.0 / rate);
  ASSERT_TRUE(o.ran);
  EXPECT_TRUE(o.finite);
  EXPECT_EQ(o.state, ExerciseState::done);
  EXPECT_FALSE(o.goals.empty());
  for (const auto& [id, time] : o.goals) EXPECT_GT(time, 0) << id;
  EXPECT_FALSE(o.faults.empty());
  for (const auto& [id, count] : o.faults) EXPECT_EQ(count, 0) << id;
  for (const auto& [id, share] : o.lasting_force) EXPECT_LT(share, 0.7) << id;
}

constexpr int some = -1;  ///< at least one, where chance of rounding decides how many

/// What a beginner's motion earns: these faults and no others.
test::Played expect_faults(const std::string& name, const std::map<std::string, int>& expected, int rate) {
  test::Played o = test::play_motion(skill(name), "rough", -1, {}, 1.0 / rate);
  EXPECT_TRUE(o.ran && o.finite);
  for (const auto& [id, count] : o.faults) {
    const auto found = expected.find(id);
    if (found != expected.end() && found->second == some) EXPECT_GE(count, 1) << id << " at " << rate << " Hz";
    else EXPECT_EQ(count, found == expected.end() ? 0 : found->second) << id << " at " << rate << " Hz";
  }
  for (const auto& [id, count] : expected) EXPECT_TRUE(o.faults.contains(id)) << id;
  return o;
}

class RoughHands : public testing::TestWithParam<int> {};
INSTANTIATE_TEST_SUITE_P(Skills, RoughHands, testing::Values(60, 120),
                         [](const auto& one) { return "At" + std::to_string(one.param) + "Hz"; });

TEST_P(RoughHands, GoThroughTheTargetsOntoThePosts) { expect_faults("1_touch_targets", {{"touched", 8}}, GetParam()); }

TEST_P(RoughHands, PushTooFarIntoThePad) {
  const test::Played o = expect_faults("2_hold_a_force", {{"too_much", 4}}, GetParam());
  for (const auto& [id, time] : o.goals) EXPECT_LT(time, 0) << id << ": no force lasted";
}

TEST_P(RoughHands, TearAtTheFlapAndMeetTheTray) {
  const test::Played o = expect_faults("3_exchange", {{"flap_pressed", some}, {"touched", 2}}, GetParam());
  for (const auto& [id, time] : o.goals) EXPECT_LT(time, 0) << id << ": nobody held the flap";
}

TEST_P(RoughHands, TearThreadsAndCutWrongOnes) {
  expect_faults("4_cut_threads", {{"torn", some}, {"wrong", some}}, GetParam());
}

TEST_P(RoughHands, LetTheClipGoBesideTheMark) {
  const test::Played o = expect_faults("5_clip_a_tube", {{"placed_elsewhere", 1}, {"tube_pulled", some}}, GetParam());
  EXPECT_LT(o.goals.at("placed"), 0);
}

TEST_P(RoughHands, SuckAtTheWallOfTheBowl) {
  const test::Played o = expect_faults("6_suction_a_pool", {{"wall", 2}}, GetParam());
  EXPECT_LT(o.goals.at("dry"), 0);
}

/// One hand alone cannot do what two must do.
TEST(SkillExchange, OneHandAloneReachesNoTarget) {
  for (const int hand : {0, 1}) {
    const test::Played o = test::play_motion(skill("3_exchange"), "steady", hand);
    ASSERT_TRUE(o.ran);
    for (const auto& [id, time] : o.goals) EXPECT_LT(time, 0) << id;
  }
}

TEST(SkillThreads, SteadyHandsCutTheMarkedOnesAlone) {
  test::Played o = test::play_motion(skill("4_cut_threads"), "steady");
  ASSERT_TRUE(o.ran);
  EXPECT_EQ(o.events["strand_cut"], 3);
  EXPECT_EQ(o.left, 4);
}

TEST(SkillTube, TheClipStaysAtItsMarkAndHoldsTheTubeShut) {
  test::Played o = test::play_motion(skill("5_clip_a_tube"), "steady");
  ASSERT_TRUE(o.ran);
  EXPECT_EQ(o.events["clip_released"], 1);
  EXPECT_LT(o.channels["flow.tube.lumen"], 0.05);
  EXPECT_LT(o.channels["placed.off"], 1e-3) << "m";
}

/// The motions are those that their generator writes.
TEST(SkillMotions, AreWhatTheirGeneratorWrites) {
  const std::filesystem::path source = INSULA_SOURCE_DIR;
  const auto folder = std::filesystem::temp_directory_path() / ("insula_skills_" + std::to_string(::getpid()));
  const std::string command =
      "python3 '" + (source / "tools/motions/skills.py").string() + "' '" + folder.string() + "'";
  ASSERT_EQ(std::system(command.c_str()), 0);
  int motions = 0;
  for (const auto& entry : std::filesystem::directory_iterator(folder)) {
    const std::string name = entry.path().filename().string();
    EXPECT_TRUE(read_file_bytes(entry.path()) == read_file_bytes(source / "scenes/skills" / name))
        << name << " is stale: python3 tools/motions/skills.py";
    ++motions;
  }
  EXPECT_EQ(motions, 12);
  std::filesystem::remove_all(folder);
}

}  // namespace
}  // namespace insula
