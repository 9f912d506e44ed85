// SPDX-License-Identifier: GPL-3.0-or-later
// What an exercise says of a scripted operation does not hang on how many steps the engine makes in a second.
#include <map>
#include <tuple>

#include "tests/exercises/play_motion.h"

namespace insula {
namespace {

using Case = std::tuple<const char*, int>;

class AtEveryRate : public testing::TestWithParam<Case> {
 protected:
  static test::Played play(double step_s) {
    const std::string name = std::string(std::get<0>(GetParam())) + ".xml";
    return test::play_motion(std::filesystem::path(INSULA_SOURCE_DIR) / "scenes/training" / name, "steady", -1, {},
                             step_s);
  }
};
INSTANTIATE_TEST_SUITE_P(Exercises, AtEveryRate,
                         testing::Combine(testing::Values("1_sylvian_fissure", "2_aneurysm_dissection", "3_clipping"),
                                          testing::Values(60, 120, 240, 480)),
                         [](const auto& one) {
                           return "Exercise" + std::string(std::get<0>(one.param)) + "_at_" +
                                  std::to_string(std::get<1>(one.param));
                         });

// The bounds hold for each rate, so that two rates differ by no more than their width.
TEST_P(AtEveryRate, TheGoodMotionReachesItsGoalsWithoutFaults) {
  const test::Played o = play(1.0 / std::get<1>(GetParam()));
  ASSERT_TRUE(o.ran);
  EXPECT_TRUE(o.finite);
  EXPECT_EQ(o.state, ExerciseState::done);
  for (const auto& [id, count] : o.faults) EXPECT_EQ(count, 0) << id;
  EXPECT_FALSE(o.lasting_force.empty());
  for (const auto& [id, share] : o.lasting_force) EXPECT_LT(share, 0.6) << id;

  // Exercise 1: the lips are 5 mm apart while the right hand still sweeps, or when it makes room.
  // Exercise 2: a strand that one sweep just reaches may wait for the next.
  using Times = std::map<std::string, std::pair<double, double>>;
  static const std::map<std::string, Times> times_s{
      {"1_sylvian_fissure", {{"open", {22, 26}}, {"divide", {53, 54.5}}, {"together", {20, 25}}}},
      {"2_aneurysm_dissection", {{"divide", {36.5, 42}}}},
      {"3_clipping", {{"clip", {9, 9.3}}}}};
  const Times& bounds = times_s.at(std::get<0>(GetParam()));
  EXPECT_EQ(o.goals.size(), bounds.size());
  for (const auto& [id, time] : o.goals) {
    ASSERT_TRUE(bounds.contains(id)) << id;
    EXPECT_GE(time, bounds.at(id).first) << id;
    EXPECT_LE(time, bounds.at(id).second) << id;
  }
}

}  // namespace
}  // namespace insula
