// SPDX-License-Identifier: GPL-3.0-or-later
// The hints of the exercises: a rough motion is told before its fault, and a steady one hears few hints or none. Those
// of exercises 3 and 4 are tested where their motions are played (clipping_test.cpp, rupture_test.cpp).
#include <optional>

#include "tests/exercises/play_motion.h"
#include "tests/exercises/told_hints.h"

namespace insula {
namespace {

std::filesystem::path scene_file(const std::string& name) {
  return std::filesystem::path(INSULA_SOURCE_DIR) / "scenes" / (name + ".xml");
}

/// What the motion hears; none if it could not be played.
std::optional<test::ToldHints> tell(const std::string& scene, const std::string& motion) {
  test::ToldHints out;
  if (!test::play_motion(scene_file(scene), motion, -1, out.listener()).ran) return std::nullopt;
  return out;
}

using Case = std::tuple<const char*, const char*>;
std::string name_of_case(const testing::TestParamInfo<Case>& one) {
  std::string name = std::string(std::get<0>(one.param)) + "_" + std::get<1>(one.param);
  std::replace(name.begin(), name.end(), '/', '_');
  return name;
}

class RoughMotion : public testing::TestWithParam<Case> {};
INSTANTIATE_TEST_SUITE_P(Hints, RoughMotion,
                         testing::Values(Case{"training/1_sylvian_fissure", "rough"},
                                         Case{"training/2_aneurysm_dissection", "rough"},
                                         Case{"skills/1_touch_targets", "rough"},
                                         Case{"skills/2_hold_a_force", "rough"}, Case{"skills/3_exchange", "rough"},
                                         Case{"skills/4_cut_threads", "rough"}, Case{"skills/5_clip_a_tube", "rough"},
                                         Case{"skills/6_suction_a_pool", "rough"}),
                         name_of_case);

TEST_P(RoughMotion, IsToldBeforeItsFault) {
  const auto told = tell(std::get<0>(GetParam()), std::get<1>(GetParam()));
  ASSERT_TRUE(told);
  EXPECT_FALSE(told->first_fault.empty());
  EXPECT_GE(told->expect_told(), 1);
}

/// Hints on the band of a metric, by scene.
class MetricHint : public testing::TestWithParam<Case> {};
INSTANTIATE_TEST_SUITE_P(Hints, MetricHint,
                         testing::Values(Case{"skills/2_hold_a_force", "mean_hint"},
                                         Case{"skills/3_exchange", "strong_hint"}),
                         name_of_case);

TEST_P(MetricHint, IsGivenToARoughHandAndNotToASteadyOne) {
  const auto [scene, hint] = GetParam();
  const auto rough = tell(scene, "rough"), steady = tell(scene, "steady");
  ASSERT_TRUE(rough && steady);
  ASSERT_TRUE(rough->first_held.contains(hint)) << "beyond its band";
  EXPECT_TRUE(rough->first_cue.contains(hint) || rough->silent_at(rough->first_held.at(hint)))
      << "neither told nor in the pause after another hint";
  EXPECT_FALSE(steady->first_held.contains(hint));
}

class SteadyMotion : public testing::TestWithParam<const char*> {};
INSTANTIATE_TEST_SUITE_P(Hints, SteadyMotion,
                         testing::Values("training/1_sylvian_fissure", "training/2_aneurysm_dissection",
                                         "skills/1_touch_targets", "skills/2_hold_a_force", "skills/3_exchange",
                                         "skills/4_cut_threads", "skills/5_clip_a_tube", "skills/6_suction_a_pool"),
                         [](const auto& one) {
                           std::string name = one.param;
                           std::replace(name.begin(), name.end(), '/', '_');
                           return name;
                         });

TEST_P(SteadyMotion, HearsFewHintsOrNone) {
  const auto told = tell(GetParam(), "steady");
  ASSERT_TRUE(told);
  told->expect_few();
}

}  // namespace
}  // namespace insula
