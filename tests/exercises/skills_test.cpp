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
                         testing::Combine(testing::Values("1_touch_targets"), testing::Values(60, 120)),
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

/// What a beginner's motion earns: exactly these kinds of faults, each as often as it is made.
void expect_faults(const std::string& name, const std::map<std::string, int>& expected, int rate) {
  const test::Played o = test::play_motion(skill(name), "rough", -1, {}, 1.0 / rate);
  ASSERT_TRUE(o.ran);
  EXPECT_TRUE(o.finite);
  for (const auto& [id, count] : o.faults) {
    const auto found = expected.find(id);
    EXPECT_EQ(count, found == expected.end() ? 0 : found->second) << id << " at " << rate << " Hz";
  }
  for (const auto& [id, count] : expected) EXPECT_TRUE(o.faults.contains(id)) << id;
}

class RoughHands : public testing::TestWithParam<int> {};
INSTANTIATE_TEST_SUITE_P(Skills, RoughHands, testing::Values(60, 120),
                         [](const auto& one) { return "At" + std::to_string(one.param) + "Hz"; });

TEST_P(RoughHands, GoThroughTheTargetsOntoThePosts) { expect_faults("1_touch_targets", {{"touched", 8}}, GetParam()); }

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
  EXPECT_EQ(motions, 2);
  std::filesystem::remove_all(folder);
}

}  // namespace
}  // namespace insula
