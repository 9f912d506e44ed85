// SPDX-License-Identifier: GPL-3.0-or-later
// Plays a scripted motion of an exercise headless, as `insula run` does, and sums up the result.
#pragma once
#include <gtest/gtest.h>

#include <algorithm>
#include <functional>
#include <map>

#include "core/registry/registry.h"
#include "core/sim/channel_sum.h"
#include "engine/live/headless.h"
#include "plugins/blood_flow/vessel_state.h"
#include "tests/exercises/lasting_force.h"

namespace insula::test {

struct Played {
  bool ran = false, finite = true;
  std::map<std::string, int> faults, events;  ///< events: how many of each kind
  std::map<std::string, double> goals;        ///< time, -1 when open
  std::map<std::string, double> measures;     ///< at the end, in their units
  std::map<std::string, double> longest;      ///< of each timer, s
  std::map<std::string, double> channels;     ///< last values of scalar channels, SI
  ExerciseState state = ExerciseState::running;
  double end = -1;      ///< of the exercise, s
  double duration = 0;  ///< of the motion, s
  int strands = 0, left = 0;
  double min_pressure = 1e300;   ///< of any stretch of vessel, Pa
  double max_force[2] = {0, 0};  ///< of each hand's tool on what it touches, N
  /// By id of a <fault_force>: the largest force that lasts as long as it forgives, over its limit.
  std::map<std::string, double> lasting_force;
};

/// The motion with this id in the scene's exercise. hand: only that hand's part of it, with all commands; -1: both.
/// `watch` sees each step's end. time_step_s: in place of the scene's own, 0: as written.
inline Played play_motion(const std::filesystem::path& scene, const std::string& id, int hand = -1,
                          const std::function<void(const Simulation&)>& watch = {}, double time_step_s = 0) {
  Played out;
  Registry registry;
  register_builtin(registry);
  SimulationResult loaded = load_simulation(scene, registry, 0, time_step_s);
  EXPECT_EQ(loaded.diagnostics.format(), "");
  if (!loaded.simulation || !loaded.simulation->exercise()) return out;
  Simulation& s = *loaded.simulation;
  Motion motion;
  for (const MotionEntry* m : s.exercise()->motions())
    if (m->id == id) motion = load_motion(m->file());
  EXPECT_FALSE(motion.empty()) << "motion " << id;
  if (hand >= 0) {
    Motion part;
    for (const Motion::Key& key : motion.keys(hand)) part.add(hand, key);
    for (const MotionCommand& command : motion.commands()) part.add(command);
    motion = std::move(part);
  }
  HeadlessRun run(s, motion);
  Vessels vessels(s);
  std::vector<LastingForce> forces;
  for (const ExerciseRule* rule : s.exercise()->children_of<ExerciseRule>())
    if (rule->element == "fault_force") forces.emplace_back(*rule);
  out.duration = motion.duration();
  while (s.time() < out.duration + 0.5) {
    run.step();
    out.finite = out.finite && s.report().finite;
    for (const ToolReport& t : s.report().tools)
      if (t.hand >= 0) out.max_force[t.hand] = std::max(out.max_force[t.hand], t.contact_force);
    for (const VesselState& v : vessels.now()) out.min_pressure = std::min(out.min_pressure, v.pressure);
    for (const Event& e : s.events()) ++out.events[e.kind];
    for (LastingForce& f : forces) f.see(s.report());
    if (watch) watch(s);
  }
  for (const LastingForce& f : forces) out.lasting_force[f.id()] = f.share_of_limit();
  for (int h = 0; h < 2; ++h)
    if (motion.has(h)) {
      EXPECT_LT((run.haptics().hand(h).device.p - motion.at(h, 1e9).pose.p).norm(), 0.001)
          << "hand " << h << " did not follow its motion to the end";
    }
  out.ran = true;
  out.strands = int(channel_sum(s, "total"));
  out.left = int(channel_sum(s, "standing"));
  for (const ChannelEntry& e : s.channels().entries())
    if (e.size() == 1) out.channels[e.id] = *e.channel->values(e.item);
  const ExerciseLog& log = s.exercise()->log();
  out.state = log.state();
  out.end = log.end_time();
  for (const FaultState& f : log.faults()) out.faults[f.id] = f.count;
  for (const MeasureState& m : log.measures()) out.measures[m.id] = m.value;
  for (const TimerState& t : log.timers()) out.longest[t.id] = t.longest;
  for (const GoalState& g : log.goals()) out.goals[g.id] = g.done ? g.time : -1;
  return out;
}

/// Both branches open, and no fault.
inline void expect_no_harm(Played& o) {
  for (const auto& [id, count] : o.faults) EXPECT_EQ(count, 0) << id;
  EXPECT_GT(o.measures["superior.flow_pct"], 90);
  EXPECT_GT(o.measures["inferior.flow_pct"], 90);
}

/// No harm, and no remnant.
inline void expect_well_clipped(Played& o) {
  expect_no_harm(o);
  EXPECT_EQ(o.measures["grade"], 0);
  EXPECT_LT(o.measures["remnant_pct"], 10);
}

/// Forces far below the limits of the exercise on brain, bone and artery. Another machine's rounding or another hand's
/// delay then does not make a fault of a good motion.
inline void expect_gentle(const Played& o) {
  EXPECT_EQ(o.lasting_force.size(), 3u);
  for (const auto& [id, share] : o.lasting_force) EXPECT_LT(share, 0.6) << id;
}

}  // namespace insula::test
