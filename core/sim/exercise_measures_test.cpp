// SPDX-License-Identifier: GPL-3.0-or-later
// Measures of an exercise are channels that components and rules declare; an end may be taken back.
#include <gtest/gtest.h>

#include "core/registry/registry.h"
#include "core/sim/simulation.h"

namespace insula {
namespace {

class Pump final : public Constraint {
 public:
  ChannelGroup<Scalar> share{this,
                             {.name = "flow",
                              .doc = "Flow over that at rest",
                              .display = "%",
                              .good = {.from = "0.75"},
                              .high = {.from = "0.5"},
                              .measure = true}};
  Channel<Force> pull{this, {.name = "pull", .doc = "no measure"}};
  void build(const StepContext&, ConstraintBuilder&) override {}
  void connect(PrepareContext&, Simulation&) override { share.declare({"left", "right"}); }
  void publish() override {
    share.set(0, value);
    pull.set(1);
  }
  double value = 0.6;
};

/// Sets its measure while it observes, and reaches its goal in the third step.
class Judge final : public ExerciseRule {
 public:
  Channel<Length> gap{this, {.name = "gap", .doc = "Gap", .display = "mm", .measure = true}};
  void prepare(PrepareContext&) override { gap.set_bands({std::nullopt, 2e-3}); }
  void declare(PrepareContext&, const Simulation&, ExerciseLog& log) override { goal_ = log.add_goal(id, "wait"); }
  void observe(const StepReport& r, ExerciseLog& log) override {
    gap.set(1e-3 * double(r.step));
    if (again) log.reopen(r.time);
    if (r.step >= 3) log.goal(goal_, r.time);
  }
  bool again = false;

 private:
  int goal_ = 0;
};

struct Bench {
  Registry registry;
  std::unique_ptr<Simulation> s;
  explicit Bench(const std::string& elements) {
    register_builtin(registry);
    registry.add<Pump>("pump", Kind::constraint, "for tests");
    registry.add<Judge>("judge", Kind::exercise_rule, "for tests");
    auto loaded = load_simulation_text("<scene>" + elements + "</scene>", "/s.xml", registry, 1);
    EXPECT_EQ(loaded.diagnostics.format(), "");
    s = std::move(loaded.simulation);
  }
  const MeasureState& measure(const std::string& id) const {
    for (const MeasureState& m : s->exercise()->log().measures())
      if (m.id == id) return m;
    throw std::runtime_error("no measure " + id);
  }
};

TEST(ExerciseMeasures, AreTheChannelsThatSaySo) {
  Bench b(R"(<pump id="p"/><exercise id="e" title="E"><judge id="j"/></exercise>)");
  ASSERT_TRUE(b.s);
  ASSERT_EQ(b.s->exercise()->log().measures().size(), 3u);
  b.s->step();
  const MeasureState left = b.measure("left.flow_pct"), gap = b.measure("gap");
  EXPECT_NEAR(left.value, 60, 1e-12);
  EXPECT_EQ(left.unit, "%");
  EXPECT_EQ(left.text, "Flow over that at rest: left");
  EXPECT_EQ(left.good, 0) << "between the bands";
  EXPECT_NEAR(left.band[0].value(), 75, 1e-12);
  EXPECT_FALSE(left.band[1]);
  EXPECT_FALSE(b.measure("right.flow_pct").known) << "was never said";
  EXPECT_NEAR(gap.value, 1, 1e-12) << "the rule's value of this step, in its unit";
  EXPECT_EQ(gap.good, 1);
  EXPECT_NEAR(gap.band[1].value(), 2, 1e-12);
  EXPECT_EQ(b.s->report().channels[b.s->channels().find("j.gap")->offset], 1e-3)
      << "the channel has it in the same step";
  b.s->scene().find_as<Pump>("p")->value = 0.3;
  for (int i = 0; i < 2; ++i) b.s->step();
  EXPECT_EQ(b.measure("left.flow_pct").good, -1);
  EXPECT_EQ(b.measure("gap").good, -1);
}

// What a page shows beside the field, its summary of the end and the report are of one moment.
TEST(ExerciseMeasures, StandStillOnceTheExerciseHasEnded) {
  Bench b(R"(<pump id="p"/><exercise id="e" title="E"><judge id="j"/></exercise>)");
  ASSERT_TRUE(b.s);
  for (int i = 0; i < 3; ++i) b.s->step();
  ASSERT_EQ(b.s->exercise()->log().state(), ExerciseState::done);
  EXPECT_NEAR(b.measure("gap").value, 3, 1e-12) << "of the step in which it ended";
  b.s->scene().find_as<Pump>("p")->value = 0.3;
  for (int i = 0; i < 2; ++i) b.s->step();
  EXPECT_NEAR(b.measure("gap").value, 3, 1e-12);
  EXPECT_EQ(b.measure("gap").good, -1);
  EXPECT_NEAR(b.measure("left.flow_pct").value, 60, 1e-12);
  const auto& channels = b.s->report().channels;
  EXPECT_EQ(channels[b.s->channels().find("j.gap")->offset], 5e-3) << "the channel goes on";
  EXPECT_EQ(channels[b.s->channels().find("p.left.flow")->offset], 0.3);
  b.s->scene().find_as<Judge>("j")->again = true;
  b.s->step();
  EXPECT_NEAR(b.measure("gap").value, 6, 1e-12) << "it was reopened";
  EXPECT_NEAR(b.measure("left.flow_pct").value, 30, 1e-12);
}

TEST(ExerciseMeasures, OfTwoComponentsHaveTheirIds) {
  Bench b(R"(<pump id="p"/><pump id="q"/><exercise id="e" title="E"/>)");
  ASSERT_TRUE(b.s);
  b.s->step();
  EXPECT_TRUE(b.measure("p.left.flow_pct").known);
  EXPECT_TRUE(b.measure("q.left.flow_pct").known);
}

TEST(ExerciseLog, AnEndBySuccessCanBeTakenBack) {
  ExerciseLog log;
  log.add_goal("g", "Close it");
  log.add_fault("f", "Too hard");
  log.goal(0, 1);
  ASSERT_EQ(log.state(), ExerciseState::done);
  log.goal_lost(0, 2);
  EXPECT_TRUE(log.goals()[0].done) << "an end is final";
  log.reopen(2);
  log.goal_lost(0, 2);
  EXPECT_EQ(log.state(), ExerciseState::running);
  EXPECT_FALSE(log.goals()[0].done);
  log.fault(0, 3, 1);
  EXPECT_EQ(log.faults()[0].count, 1) << "faults count again";
  log.fail("over", 4);
  log.reopen(5);
  EXPECT_EQ(log.state(), ExerciseState::failed) << "a failure stays";
}

}  // namespace
}  // namespace insula
