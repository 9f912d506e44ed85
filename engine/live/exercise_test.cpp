// SPDX-License-Identifier: GPL-3.0-or-later
// Exercise 1 from start to end with both scripted motions, headless.
#include <gtest/gtest.h>

#include <unistd.h>
#include <cmath>
#include <cstdlib>

#include <fstream>
#include <map>
#include <sstream>

#include "core/registry/registry.h"
#include "core/sim/channel_sum.h"
#include "engine/live/headless.h"

namespace insula {
namespace {

namespace fs = std::filesystem;
const fs::path source = INSULA_SOURCE_DIR;
const fs::path scene = source / "scenes/training/1_sylvian_fissure.xml";

std::string bytes(const fs::path& file) {
  std::stringstream out;
  out << std::ifstream(file, std::ios::binary).rdbuf();
  return out.str();
}

const Registry& builtin() {
  static const Registry registry = [] {
    Registry r;
    register_builtin(r);
    return r;
  }();
  return registry;
}

struct Outcome {
  std::map<std::string, int> faults;
  std::map<std::string, double> goals;  ///< time, -1 when open
  ExerciseState state = ExerciseState::running;
  int strands = 0, left = 0, torn = 0, cut = 0;
  double max_force[2] = {0, 0};  ///< of a hand, N
  double max_press = 0;          ///< of one tool on one lobe, N
  double retraction_s = 0;       ///< metric: with the lips held apart
  bool finite = true;
  Vec3 device[2];
};

/// The part of a motion that one hand does: 0 left, 1 right.
Motion of_hand(const Motion& both, int hand) {
  Motion out;
  for (const Motion::Key& key : both.keys(hand)) out.add(hand, key);
  return out;
}

/// Plays a motion of the exercise. hand: only that hand's part of it; -1: both.
Outcome perform(const std::string& id, int hand = -1) {
  Outcome out;
  SimulationResult loaded = load_simulation(scene, builtin());
  EXPECT_TRUE(loaded.simulation) << loaded.diagnostics.format();
  EXPECT_EQ(loaded.diagnostics.format(), "");
  if (!loaded.simulation || !loaded.simulation->exercise()) {
    ADD_FAILURE() << "no exercise";
    return out;
  }
  Simulation& s = *loaded.simulation;
  Motion motion;
  for (const MotionEntry* m : s.exercise()->motions())
    if (m->id == id) motion = load_motion(m->file());
  EXPECT_TRUE(motion.has(0) && motion.has(1)) << "motion " << id;
  if (hand >= 0) motion = of_hand(motion, hand);
  HeadlessRun run(s, motion);
  while (s.time() < motion.duration() + 0.5) {
    run.step();
    const StepReport& r = s.report();
    out.finite = out.finite && r.finite;
    std::map<std::pair<const Body*, const Body*>, Vec3> press;
    for (const ContactPoint& c : r.contacts) {
      const Vec3 f = c.normal_force * c.normal + c.tangent_force;
      press.try_emplace({c.a, c.b}, Vec3::Zero()).first->second += f;
    }
    for (const auto& [pair, f] : press)
      if (dynamic_cast<const Instrument*>(pair.first) || dynamic_cast<const Instrument*>(pair.second))
        out.max_press = std::max(out.max_press, f.norm());
    for (const ToolReport& t : r.tools)
      if (t.hand >= 0) out.max_force[t.hand] = std::max(out.max_force[t.hand], t.hand_force.head<3>().norm());
    for (const Event& e : s.events()) {
      out.torn += e.kind == "strand_torn";
      out.cut += e.kind == "strand_cut";
    }
  }
  out.strands = int(channel_sum(s, "total"));
  out.left = int(channel_sum(s, "standing"));
  const ExerciseLog& log = s.exercise()->log();
  out.state = log.state();
  for (const FaultState& f : log.faults()) out.faults[f.id] = f.count;
  for (const GoalState& g : log.goals()) out.goals[g.id] = g.done ? g.time : -1;
  for (const MetricValue& m : s.exercise()->metrics())
    if (m.id == "retraction_held") out.retraction_s = m.value;
  for (int h = 0; h < 2; ++h) out.device[h] = run.haptics().hand(h).device.p;
  for (int h = 0; h < 2; ++h)
    if (motion.has(h)) {
      EXPECT_LT((out.device[h] - motion.at(h, 1e9).pose.p).norm(), 0.001)
          << "hand " << h << " did not follow its motion to the end";
    }
  return out;
}

TEST(SylvianFissure, SteadyHandsCompleteItWithoutAFault) {
  const Outcome o = perform("steady");
  EXPECT_TRUE(o.finite);
  EXPECT_GE(o.strands, 45);
  EXPECT_LE(o.strands, 70);
  EXPECT_EQ(o.left, 1) << "the vein that bridges the fissure";
  EXPECT_EQ(o.cut, o.strands - 1);
  EXPECT_EQ(o.torn, 0);
  ASSERT_EQ(o.faults.size(), 5u);
  for (const auto& [id, count] : o.faults) EXPECT_EQ(count, 0) << id;
  ASSERT_EQ(o.goals.size(), 3u);
  for (const auto& [id, time] : o.goals) EXPECT_GT(time, 0) << id;
  EXPECT_EQ(o.state, ExerciseState::done);
  EXPECT_GE(o.retraction_s, 2) << "as the goal asks";
  EXPECT_LE(o.retraction_s, o.goals.at("divide") + 2);
  for (const double f : o.max_force) {
    EXPECT_GT(f, 0.03) << "a hand that feels nothing";
    EXPECT_LT(f, 0.25);
  }
  EXPECT_LT(o.max_press, 0.25);
}

// A steady left hand draws the lobe. A steady right one divides every strand by itself, so the goal of both hands comes
// out of reach.
TEST(SylvianFissure, OneHandAloneDoesNotCompleteIt) {
  const ExerciseState ends[2] = {ExerciseState::running, ExerciseState::failed};
  for (int hand = 0; hand < 2; ++hand) {
    const Outcome o = perform("steady", hand);
    EXPECT_EQ(o.state, ends[hand]) << "hand " << hand;
    EXPECT_LT(o.goals.at("together"), 0) << "hand " << hand;
  }
}

TEST(SylvianFissure, RoughHandsEarnEveryKindOfFault) {
  const Outcome o = perform("rough");
  EXPECT_TRUE(o.finite);
  for (const char* id : {"brain_force", "torn", "order"}) EXPECT_GE(o.faults.at(id), 1) << id;
  EXPECT_GE(o.torn, 1);
  EXPECT_GT(o.left, 0);
  EXPECT_EQ(o.state, ExerciseState::running);
}

// Rules only watch: the same hands in the scene without its exercise give the same bits.
TEST(SylvianFissure, TheExerciseDoesNotTouchTheTissue) {
  std::string text = bytes(scene);
  const std::size_t from = text.find("<exercise"), to = text.find("</exercise>");
  ASSERT_TRUE(from != std::string::npos && to != std::string::npos);
  text.erase(from, to + 11 - from);
  SimulationResult with = load_simulation(scene, builtin()), without = load_simulation_text(text, scene, builtin());
  ASSERT_TRUE(with.simulation) << with.diagnostics.format();
  ASSERT_TRUE(without.simulation) << without.diagnostics.format();
  ASSERT_TRUE(with.simulation->exercise());
  ASSERT_FALSE(without.simulation->exercise());
  const Motion motion = load_motion(source / "scenes/training/1_sylvian_fissure_rough.csv");
  HeadlessRun a(*with.simulation, motion), b(*without.simulation, motion);
  for (int i = 0; i < 210; ++i) {
    a.step();
    b.step();
    if (i % 10 == 0) {
      ASSERT_EQ(with.simulation->state_hash(), without.simulation->state_hash()) << "step " << i;
    }
  }
  int faults = 0;
  for (const FaultState& f : with.simulation->exercise()->log().faults()) faults += f.count;
  EXPECT_GT(faults, 0) << "nothing was watched";
}

TEST(SylvianFissure, MotionsAreWhatTheGeneratorWrites) {
  const fs::path folder = fs::temp_directory_path() / ("insula_motions_" + std::to_string(std::uint64_t(::getpid())));
  fs::create_directories(folder);
  const std::string command =
      "python3 '" + (source / "tools/motions/sylvian_fissure.py").string() + "' '" + folder.string() + "'";
  ASSERT_EQ(std::system(command.c_str()), 0);
  for (const char* id : {"steady", "rough"}) {
    const std::string name = std::string("1_sylvian_fissure_") + id + ".csv";
    const std::string shipped = bytes(source / "scenes/training" / name);
    EXPECT_GT(shipped.size(), 1000u);
    EXPECT_TRUE(bytes(folder / name) == shipped) << name << " is stale: python3 tools/motions/sylvian_fissure.py";
  }
  fs::remove_all(folder);
}

TEST(BenchFissure, HoldsMoreThan120Rows) {
  SimulationResult loaded = load_simulation(source / "scenes/cases/bench_training.xml", builtin());
  ASSERT_TRUE(loaded.simulation) << loaded.diagnostics.format();
  for (int i = 0; i < 5; ++i) {
    loaded.simulation->step();
    EXPECT_GE(loaded.simulation->report().rows, 120);
  }
}

TEST(LargeFissure, LoadsAndSteps) {
  SimulationResult loaded = load_simulation(source / "scenes/cases/bench_large.xml", builtin());
  ASSERT_TRUE(loaded.simulation) << loaded.diagnostics.format();
  for (int i = 0; i < 3; ++i) loaded.simulation->step();
  EXPECT_TRUE(loaded.simulation->report().finite);
  EXPECT_GT(loaded.simulation->report().rows, 0);
}

}  // namespace
}  // namespace insula
