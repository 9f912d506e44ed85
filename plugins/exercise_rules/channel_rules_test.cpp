// SPDX-License-Identifier: GPL-3.0-or-later
// Goals and faults on channels and events: limits in units, hold and grace, and what is said of a wrong name or unit.
#include <gtest/gtest.h>

#include "core/registry/registry.h"
#include "core/sim/simulation.h"

namespace insula {
namespace {

class Gauge final : public Constraint {
 public:
  Channel<Force> tension{this, {.name = "tension", .doc = "for tests"}};
  Channel<Vec<Force>> pull{this, {.name = "pull", .doc = "for tests"}};
  EventKind snap{this, {.name = "snap", .doc = "for tests"}};
  void build(const StepContext&, ConstraintBuilder&) override {}
  void finish(const StepContext& context, const ConstraintSolution&) override {
    for (; snaps > 0; --snaps) context.events->emit({snap.name(), id, "", 0, context.time + context.h});
  }
  void publish() override {
    tension.set(value);
    pull.set(Vec3(0, 0.6 * value, 0.8 * value));
  }
  double value = 0;
  int snaps = 0;  ///< in the next step
};

struct Bench {
  Registry registry;
  SimulationResult loaded;
  Gauge* gauge = nullptr;
  explicit Bench(const std::string& rules) {
    register_builtin(registry);
    registry.add<Gauge>("gauge", Kind::constraint, "for tests");
    loaded = load_simulation_text(
        "<scene time_step=\"10 ms\"><gauge id=\"g\"/><exercise title=\"E\">\n" + rules + "</exercise></scene>",
        "/s.xml", registry, 1);
    if (loaded.simulation) gauge = loaded.simulation->scene().find_as<Gauge>("g");
  }
  std::string messages() const { return loaded.diagnostics.format(); }
  void hold(double newtons, int steps) const {
    gauge->value = newtons;
    for (int i = 0; i < steps; ++i) loaded.simulation->step();
  }
  const ExerciseLog& log() const { return loaded.simulation->exercise()->log(); }
};

TEST(ChannelRules, AGoalIsReachedAfterTheHold) {
  Bench b(R"(<goal_channel id="pull" text="Pull" channel="g.tension" limit="200 mN" hold="50 ms"/>)");
  ASSERT_TRUE(b.gauge) << b.messages();
  b.hold(0.21, 4);
  b.hold(0.19, 1);
  b.hold(0.21, 4);
  EXPECT_FALSE(b.log().goals()[0].done) << "the time counts afresh";
  b.hold(0.21, 1);
  EXPECT_TRUE(b.log().goals()[0].done);
}

TEST(ChannelRules, TheGoalsPlaceIsMarkedUntilItIsReached) {
  const auto marks = [](const Bench& b, const char* goal) {
    return b.loaded.simulation->scene().find(goal)->drawables().front()->count();
  };
  Bench b(R"(<goal_channel id="pull" text="Pull" channel="g.tension" limit="0.2 N" at="1 2 3 mm"/>
             <goal_channel id="anywhere" text="Pull" channel="g.tension" limit="0.2 N"/>)");
  ASSERT_TRUE(b.gauge) << b.messages();
  b.hold(0.1, 2);
  EXPECT_EQ(marks(b, "pull"), 1);
  EXPECT_EQ(marks(b, "anywhere"), 0);
  b.hold(0.3, 2);
  b.hold(0.1, 2);
  EXPECT_EQ(marks(b, "pull"), 0) << "what is reached stays so";
  b.loaded.simulation->reset();
  b.hold(0.1, 1);
  EXPECT_EQ(marks(b, "pull"), 1);
}

TEST(ChannelRules, AFaultCountsOnceUntilTheChannelIsBack) {
  Bench b(R"(<fault_channel id="tight" text="Too tight" channel="g.pull" limit="0.2 N" grace="30 ms"/>)");
  ASSERT_TRUE(b.gauge) << b.messages();
  b.hold(0.3, 3);
  EXPECT_EQ(b.log().faults()[0].count, 0) << "forgiven";
  b.hold(0.3, 10);
  EXPECT_EQ(b.log().faults()[0].count, 1) << "the length of the vector is above";
  b.hold(0.19, 5);
  b.hold(0.3, 10);
  EXPECT_EQ(b.log().faults()[0].count, 1) << "it was not back by a tenth";
  b.hold(0.17, 1);
  b.hold(0.3, 10);
  EXPECT_EQ(b.log().faults()[0].count, 2);
}

TEST(ChannelRules, BelowIsTheOtherSide) {
  Bench b(R"(<fault_channel text="Slack" channel="g.tension" comparison="below" limit="0.1 N"/>)");
  ASSERT_TRUE(b.gauge) << b.messages();
  b.hold(0.11, 5);
  EXPECT_EQ(b.log().faults()[0].count, 0);
  b.hold(0.09, 5);
  EXPECT_EQ(b.log().faults()[0].count, 1);
}

TEST(EventRules, AGoalCountsItsEvents) {
  Bench b(R"(<goal_event id="twice" text="Snap it twice" event="snap" count="2"/>)");
  ASSERT_TRUE(b.gauge) << b.messages();
  const auto done = [&] { return b.log().goals()[0].done; };
  b.gauge->snaps = 1;
  b.hold(0, 5);
  EXPECT_FALSE(done());
  b.loaded.simulation->reset();
  b.gauge->snaps = 1;
  b.hold(0, 1);
  EXPECT_FALSE(done()) << "a reset forgets the first one";
  b.gauge->snaps = 1;
  b.hold(0, 1);
  EXPECT_TRUE(done());
}

TEST(EventRules, AnEventCountsOnlyOnTheRightSideOfTheLimit) {
  Bench b(R"(<goal_event text="T" event="snap" channel="g.tension" comparison="below" limit="100 mN"/>
             <goal_event text="T" event="snap" channel="g.tension" limit="0.3 N"/>)");
  ASSERT_TRUE(b.gauge) << b.messages();
  const auto done = [&] { return std::pair(b.log().goals()[0].done, b.log().goals()[1].done); };
  b.gauge->snaps = 3;
  b.hold(0.2, 1);
  b.hold(0.05, 1);
  b.hold(0.35, 1);
  EXPECT_EQ(done(), std::pair(false, false)) << "the event comes at another time";
  b.gauge->snaps = 1;
  b.hold(0.05, 1);
  EXPECT_EQ(done(), std::pair(true, false));
  b.gauge->snaps = 1;
  b.hold(0.35, 1);
  EXPECT_EQ(done(), std::pair(true, true));
}

TEST(EventRules, AWrongEventOrALimitWithoutAChannelIsALocatedError) {
  const std::string event = Bench(R"(<goal_event text="T" event="snaps"/>)").messages();
  EXPECT_NE(event.find("s.xml:2:"), std::string::npos) << event;
  EXPECT_NE(event.find("snap"), std::string::npos) << event;
  const std::string limit = Bench(R"(<goal_event text="T" event="snap" limit="1 N"/>)").messages();
  EXPECT_NE(limit.find("is a limit of no channel"), std::string::npos) << limit;
}

TEST(ChannelRules, AWrongNameOrUnitIsALocatedError) {
  const std::string name = Bench(R"(<fault_channel text="T" channel="g.tensoin" limit="1 N"/>)").messages();
  EXPECT_NE(name.find("s.xml:2:"), std::string::npos) << name;
  EXPECT_NE(name.find("did you mean \"g.tension\"?"), std::string::npos) << name;
  const std::string unit = Bench(R"(<goal_channel text="T" channel="g.tension" limit="1 mmHg"/>)").messages();
  EXPECT_NE(unit.find("s.xml:2:"), std::string::npos) << unit;
  EXPECT_NE(unit.find("force"), std::string::npos) << unit;
}

}  // namespace
}  // namespace insula
