// SPDX-License-Identifier: GPL-3.0-or-later
// Which hints a motion hears, and whether each of its faults was told before. It listens to a motion that another test
// plays anyway: test::play_motion(scene, id, -1, told.listener()).
#pragma once
#include <gtest/gtest.h>

#include <algorithm>
#include <functional>
#include <map>
#include <string>
#include <vector>

#include "core/sim/simulation.h"
#include "core/sim/tutor.h"
#include "plugins/hints/hint.h"

namespace insula::test {

class ToldHints {
 public:
  /// Shortest time from a hint to the fault that it guards against, and longest one from the cause to the cue, s.
  static constexpr double least_lead = 0.1, most_late = 0.2;

  std::vector<Cue> cues;
  std::map<std::string, double> first_fault;  ///< by rule, s
  std::map<std::string, double> first_cue;    ///< by hint, s
  std::map<std::string, double> first_held;   ///< by hint: when it first was at its warning, s

  std::function<void(const Simulation&)> listener() {
    return [this](const Simulation& s) { see(s); };
  }

  /// Each first fault was foreseen in time, and told but for the pause after another hint. Returns how many were told.
  int expect_told() const {
    int count = 0;
    for (const auto& [rule, fault] : first_fault) {
      if (unforeseen().contains(rule)) continue;
      EXPECT_TRUE(in_time(first_held, rule, fault)) << rule << " at " << fault << " s was not foreseen";
      if (in_time(first_cue, rule, fault)) ++count;
      else EXPECT_TRUE(silent_at(fault)) << rule << " at " << fault << " s came without a hint";
    }
    for (const auto& [hint, held] : first_held)
      EXPECT_TRUE(silent_at(held) || silent_at(held + most_late))
          << hint << " held from " << held << " s on, and nothing was said";
    for (std::size_t k = 1; k < cues.size(); ++k)
      EXPECT_GE(cues[k].time - cues[k - 1].time, 10 - 1e-6) << "two hints within ten seconds";
    return count;
  }
  /// A motion without a fault hears at most one hint, and none at its limit.
  void expect_few() const {
    for (const Cue& c : cues) EXPECT_LT(c.cause.share, 1) << c.cause.id << " at " << c.time << " s: " << c.cause.value;
    EXPECT_LE(cues.size(), 1u);
  }
  /// Whether another cue was given so shortly before that the tutor had to be silent.
  bool silent_at(double time) const {
    return std::any_of(cues.begin(), cues.end(), [&](const Cue& c) { return c.time <= time && c.time > time - 10; });
  }

 private:
  struct HintOfScene {
    std::string id;
    double warning = 1;
    std::vector<std::string> guards;  ///< rules
  };

  /// Faults that nothing foretells, with the reason.
  static const std::map<std::string, std::string>& unforeseen() {
    static const std::map<std::string, std::string> out{
        {"order", "which strand a blade cuts next is not known before it does"},
        {"wrong", "which thread a blade cuts next is not known before it does"},
        {"slipped", "a clip holds by friction, and does not move before it slips"},
        {"placed_elsewhere", "a clip is let go by a button, at once"},
    };
    return out;
  }
  /// A parameter of a component as it is written.
  static std::string written(const Component& of, const std::string& name) {
    for (const ParamBase* p : of.params())
      if (p->name() == name) return p->text();
    return {};
  }
  /// Hints that have no rule="...", with the rules that they guard.
  static std::vector<std::string> guarded_by(const Component& hint) {
    static const std::map<std::string, std::vector<std::string>> by_channel{
        {"fast_hint", {"touched", "wall"}}, {"rupture_hint", {"rupture"}}, {"vein_hint", {"vein"}}};
    if (const std::string rule = written(hint, "rule"); !rule.empty()) return {rule};
    const auto found = by_channel.find(hint.id);
    return found == by_channel.end() ? std::vector<std::string>{} : found->second;
  }

  void see(const Simulation& s) {
    const GivesCues* tutor = tutor_of(*s.exercise());
    ASSERT_TRUE(tutor);
    if (hints_.empty())
      for (const Hint* h : s.exercise()->children_of<Hint>()) hints_.push_back({h->id, h->warning(), guarded_by(*h)});
    for (const HintOfScene& h : hints_)
      if (s.channel(h.id + ".share") >= h.warning) first_held.try_emplace(h.id, s.time());
    for (const Event& e : s.events())
      if (e.kind == "fault") first_fault.try_emplace(e.id, e.time);
    cues = tutor->cues();
    for (const Cue& cue : cues) first_cue.try_emplace(cue.cause.id, cue.time);
  }
  /// Whether a hint that guards the rule came so long before its first fault. times: by hint.
  bool in_time(const std::map<std::string, double>& times, const std::string& rule, double fault) const {
    return std::any_of(hints_.begin(), hints_.end(), [&](const HintOfScene& h) {
      const auto at = times.find(h.id);
      return std::find(h.guards.begin(), h.guards.end(), rule) != h.guards.end() && at != times.end() &&
             at->second <= fault - least_lead;
    });
  }

  std::vector<HintOfScene> hints_;
};

}  // namespace insula::test
