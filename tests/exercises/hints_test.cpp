// SPDX-License-Identifier: GPL-3.0-or-later
// The hints of the exercises: a rough motion is told before its fault, and a steady one hears few hints or none.
#include "core/sim/tutor.h"
#include "tests/exercises/play_motion.h"

namespace insula {
namespace {

/// Shortest time from a hint to the fault that it guards against, s.
constexpr double least_lead = 0.1;

/// Faults that nothing foretells, with the reason.
const std::map<std::string, std::string> unforeseen{
    {"order", "which strand a blade cuts next is not known before it does"},
    {"wrong", "which thread a blade cuts next is not known before it does"},
    {"slipped", "a clip holds by friction, and does not move before it slips"},
    {"placed_elsewhere", "a clip is let go by a button, at once"},
};
/// Hints that have no rule="...", with the rule that they guard.
const std::map<std::string, std::vector<std::string>> guarded_by_channel{
    {"fast_hint", {"touched", "wall"}}, {"rupture_hint", {"rupture"}}, {"vein_hint", {"vein"}}};

struct Told {
  std::vector<Cue> cues;
  std::map<std::string, double> first_fault;                ///< by rule, s
  std::map<std::string, std::vector<std::string>> guarded;  ///< rules, by id of their hint
  std::map<std::string, double> first_cue;                  ///< by hint, s
  std::map<std::string, double> first_held;                 ///< by hint: when it first was at its warning, s
  bool ran = false;
};

std::filesystem::path scene_file(const std::string& name) {
  return std::filesystem::path(INSULA_SOURCE_DIR) / "scenes" / (name + ".xml");
}

/// A parameter of a component as it is written.
std::string written(const Component& of, const std::string& name) {
  for (const ParamBase* p : of.params())
    if (p->name() == name) return p->text();
  return {};
}

struct HintOfScene {
  std::string id;
  double warning = 1;
};

std::vector<HintOfScene> hints_of(const Exercise& exercise, Told& told) {
  std::vector<HintOfScene> out;
  for (const auto& child : exercise.children) {
    if (!child->element.starts_with("hint_")) continue;
    out.push_back({child->id, std::stod(written(*child, "warning"))});
    if (const std::string rule = written(*child, "rule"); !rule.empty()) told.guarded[child->id] = {rule};
    else if (const auto found = guarded_by_channel.find(child->id); found != guarded_by_channel.end())
      told.guarded[child->id] = found->second;
  }
  return out;
}

Told tell(const std::string& scene, const std::string& motion) {
  Told out;
  std::vector<HintOfScene> hints;
  const test::Played played = test::play_motion(scene_file(scene), motion, -1, [&](const Simulation& s) {
    const GivesCues* tutor = tutor_of(*s.exercise());
    ASSERT_TRUE(tutor);
    if (hints.empty()) hints = hints_of(*s.exercise(), out);
    for (const HintOfScene& h : hints)
      if (s.channel(h.id + ".share") >= h.warning) out.first_held.try_emplace(h.id, s.time());
    for (const Event& e : s.events())
      if (e.kind == "fault") out.first_fault.try_emplace(e.id, e.time);
    out.cues = tutor->cues();
  });
  out.ran = played.ran;
  for (const Cue& cue : out.cues) out.first_cue.try_emplace(cue.cause.id, cue.time);
  return out;
}

/// Whether another cue was given so shortly before that the tutor had to be silent.
bool silent_at(const Told& told, double time) {
  return std::any_of(told.cues.begin(), told.cues.end(),
                     [&](const Cue& c) { return c.time <= time && c.time > time - 10; });
}

/// Whether a hint that guards the rule came so long before its first fault. times: by hint.
bool in_time(const Told& told, const std::map<std::string, double>& times, const std::string& rule, double fault) {
  return std::any_of(told.guarded.begin(), told.guarded.end(), [&](const auto& hint) {
    const auto& rules = hint.second;
    const auto at = times.find(hint.first);
    return std::find(rules.begin(), rules.end(), rule) != rules.end() && at != times.end() &&
           at->second <= fault - least_lead;
  });
}

/// Each first fault was foreseen in time, and told but for the pause after another hint. Returns how many were told.
int expect_told(const Told& told) {
  int count = 0;
  for (const auto& [rule, fault] : told.first_fault) {
    if (unforeseen.contains(rule)) continue;
    EXPECT_TRUE(in_time(told, told.first_held, rule, fault)) << rule << " at " << fault << " s was not foreseen";
    if (in_time(told, told.first_cue, rule, fault)) ++count;
    else EXPECT_TRUE(silent_at(told, fault)) << rule << " at " << fault << " s came without a hint";
  }
  for (std::size_t k = 1; k < told.cues.size(); ++k)
    EXPECT_GE(told.cues[k].time - told.cues[k - 1].time, 10 - 1e-6) << "two hints within ten seconds";
  return count;
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
  const Told told = tell(std::get<0>(GetParam()), std::get<1>(GetParam()));
  ASSERT_TRUE(told.ran);
  EXPECT_FALSE(told.first_fault.empty());
  EXPECT_GE(expect_told(told), 1);
}

// The clip presses the brain aside on its way, which is told first. The perforator is within the pause of that hint.
TEST(Hints, APerforatorThatAClipShutsIsForeseen) {
  const Told told = tell("training/3_clipping", "perforator_caught");
  ASSERT_TRUE(told.ran);
  EXPECT_TRUE(told.first_fault.contains("perforator_shut"));
  expect_told(told);
}

/// Hints on the band of a metric, by scene.
class MetricHint : public testing::TestWithParam<Case> {};
INSTANTIATE_TEST_SUITE_P(Hints, MetricHint,
                         testing::Values(Case{"skills/2_hold_a_force", "mean_hint"},
                                         Case{"skills/3_exchange", "strong_hint"}),
                         name_of_case);

TEST_P(MetricHint, IsGivenToARoughHandAndNotToASteadyOne) {
  const auto [scene, hint] = GetParam();
  const Told rough = tell(scene, "rough"), steady = tell(scene, "steady");
  ASSERT_TRUE(rough.ran && steady.ran);
  ASSERT_TRUE(rough.first_held.contains(hint)) << "beyond its band";
  EXPECT_TRUE(rough.first_cue.contains(hint) || silent_at(rough, rough.first_held.at(hint)))
      << "neither told nor in the pause after another hint";
  EXPECT_FALSE(steady.first_held.contains(hint));
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
  const Told told = tell(GetParam(), "steady");
  ASSERT_TRUE(told.ran);
  for (const Cue& c : told.cues)
    EXPECT_LT(c.cause.share, 1) << c.cause.id << " at " << c.time << " s: " << c.cause.value;
  EXPECT_LE(told.cues.size(), 1u);
}

}  // namespace
}  // namespace insula
