// SPDX-License-Identifier: GPL-3.0-or-later
// Each rule against step reports made by hand: what counts, what is forgiven, what is counted once.
#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <iterator>

#include "core/testing/example.h"
#include "plugins/strand_springs/strand_set.h"

namespace insula {
namespace {

const std::filesystem::path example = std::filesystem::path(INSULA_SOURCE_DIR) / "plugins/exercise_rules/example.xml";

/// Strands that a test puts where it wants them.
class FakeStrands final : public Constraint, public StrandSet {
 public:
  void build(const StepContext&, ConstraintBuilder&) override {}
  int strand_count() const override { return int(strands.size()); }
  StrandState strand(int i) const override { return strands[std::size_t(i)]; }
  std::vector<StrandState> strands;
  Channel<Scalar> standing{this, {.name = "standing", .doc = "for tests"}};
  Channel<Force> tension{this, {.name = "tension", .doc = "for tests"}};
  EventKind cut{this, {.name = "strand_cut", .doc = "for tests"}};
};

/// The example scene with strands of the test; its exercise is shown reports instead of steps.
class Rules : public ::testing::Test {
 protected:
  void SetUp() override {
    registry.add<FakeStrands>("fake_strands", Kind::constraint, "for tests");
    std::ifstream in(example);
    std::string text{std::istreambuf_iterator<char>(in), {}};
    const std::size_t at = text.find("<strand_springs");
    ASSERT_NE(at, std::string::npos);
    text.replace(at, text.find("/>", at) + 2 - at, "<fake_strands id=\"strands\"/>");
    // The fake strands publish no tension, so no goal on it could be reached.
    for (const char* of_tension : {"<goal_channel", "<goal_event"}) {
      const std::size_t goal = text.find(of_tension);
      ASSERT_NE(goal, std::string::npos);
      text.erase(goal, text.find("/>", goal) + 2 - goal);
    }
    auto loaded = load_simulation_text(text, example, registry, 1);
    ASSERT_TRUE(loaded.simulation) << loaded.diagnostics.format();
    s = std::move(loaded.simulation);
    ASSERT_TRUE(s->exercise());
    fake = s->scene().find_as<FakeStrands>("strands");
    knife = s->scene().find_as<Instrument>("knife");
    lower = s->scene().find_as<SoftBody>("lower");
    upper = s->scene().find_as<SoftBody>("upper");
    ASSERT_TRUE(knife && lower && upper);
    report.h = 0.05;
    report.structures = s->report().structures;
  }
  void show() {
    report.time += report.h;
    s->exercise()->log().events.clear();
    s->exercise()->observe(report);
  }
  const GoalState& goal(const std::string& id) {
    for (const GoalState& g : s->exercise()->log().goals())
      if (g.id == id) return g;
    throw std::runtime_error("no goal " + id);
  }
  const MeasureState& measure(const std::string& id) {
    for (const MeasureState& m : s->exercise()->log().measures())
      if (m.id == id) return m;
    throw std::runtime_error("no measure " + id);
  }
  int faults(const std::string& id) {
    for (const FaultState& f : s->exercise()->log().faults())
      if (f.id == id) return f.count;
    throw std::runtime_error("no fault " + id);
  }
  int all_faults() { return faults("force") + faults("torn") + faults("order"); }
  /// The hands push a body with these forces, and nothing else.
  void push(const Body* body, double right_N, double left_N = 0) {
    for (StructureForce& f : report.structures) {
      const bool pushed = f.body == body;
      f.of_hand = {Vec3(0, pushed ? left_N : 0, 0), Vec3(0, 0, pushed ? right_N : 0)};
    }
  }
  /// Strands along x, the first nearest to the surface (inward is -x), 3 mm apart.
  void strands(int n) {
    fake->strands.clear();
    for (int i = 0; i < n; ++i) {
      StrandState t;
      t.a = Vec3(-0.003 * i, 0, 0);
      t.b = Vec3(-0.003 * i, 0, 0.002);
      fake->strands.push_back(t);
    }
  }
  void part(std::initializer_list<int> which) {
    for (int i : which) {
      fake->strands[std::size_t(i)].integrity = -1;
    }
  }

  static Registry builtin() {
    Registry r;
    register_builtin(r);
    return r;
  }
  Registry registry = builtin();
  std::unique_ptr<Simulation> s;
  FakeStrands* fake = nullptr;
  Instrument* knife = nullptr;
  SoftBody *lower = nullptr, *upper = nullptr;
  StepReport report;
};

TEST_F(Rules, StrandsGoalWantsItsFraction) {
  strands(4);
  show();
  EXPECT_FALSE(goal("divide").done);
  part({0});
  show();
  EXPECT_FALSE(goal("divide").done) << "a quarter is not half";
  EXPECT_NEAR(measure("divided_pct").value, 25, 1e-12);
  EXPECT_EQ(measure("divided_pct").good, 0) << "not yet, but nothing is wrong";
  part({1});
  show();
  EXPECT_EQ(measure("divided_pct").good, 1);
  EXPECT_TRUE(goal("divide").done);
  EXPECT_DOUBLE_EQ(goal("divide").time, report.time);
  EXPECT_EQ(s->exercise()->log().state(), ExerciseState::running) << "the other goal is still open";
}

TEST_F(Rules, TheLastStrandsAreAimsUntilTheGoalIsReached) {
  Component& rule = *s->scene().find("divide");
  const DrawableBase& aims = *rule.drawables().at(0);
  const auto count = [&] {
    rule.publish();
    return aims.count();
  };
  strands(12);  // half of them are asked for
  part({0, 1, 2, 3});
  EXPECT_EQ(count(), 0) << "two of six are missing, which is more than a fifth";
  part({4});
  ASSERT_EQ(count(), 7) << "any one of the seven that stand will do";
  EXPECT_NEAR(aims.data()[0], -0.015, 1e-9) << "of the first one that stands, x";
  EXPECT_NEAR(aims.data()[2], 0.001, 1e-9) << "its middle";
  part({5});
  EXPECT_EQ(count(), 0) << "enough are parted";
}

TEST_F(Rules, NoStrandsIsNoGoal) {
  show();
  EXPECT_FALSE(goal("divide").done);
}

TEST_F(Rules, OpeningMustBeHeldWithoutABreak) {
  const VecX rest = upper->q();
  const auto lift = [&](double metres) {
    upper->q() = rest;
    for (int i = 0; i < upper->nodes(); ++i) upper->q()[3 * i + 2] += metres;
  };
  lift(0.0038);  // 5.8 mm
  for (int i = 0; i < 10; ++i) show();
  EXPECT_FALSE(goal("open").done) << "too narrow";
  lift(0.0042);  // 6.2 mm
  for (int i = 0; i < 3; ++i) show();
  EXPECT_FALSE(goal("open").done) << "0.15 s of 0.2 s";
  lift(0);
  show();
  lift(0.0042);
  for (int i = 0; i < 3; ++i) show();
  EXPECT_FALSE(goal("open").done) << "the time counts afresh after a break";
  for (int i = 0; i < 2; ++i) show();
  EXPECT_TRUE(goal("open").done);
  EXPECT_NEAR(measure("opening").value, 6.2, 0.05) << "the largest so far, mm";
  EXPECT_EQ(measure("opening").good, 1);
}

TEST_F(Rules, ForceCountsAfterTheGraceAndOncePerPush) {
  push(lower, 0.29);
  for (int i = 0; i < 20; ++i) show();
  EXPECT_EQ(faults("force"), 0) << "below the limit";
  push(lower, 0.31);
  for (int i = 0; i < 2; ++i) show();
  EXPECT_EQ(faults("force"), 0) << "no longer than the grace";
  show();
  EXPECT_EQ(faults("force"), 1);
  ASSERT_EQ(s->exercise()->log().events.events().size(), 1u);
  EXPECT_NEAR(s->exercise()->log().events.events()[0].value, 0.31, 1e-12);
  for (int i = 0; i < 20; ++i) show();
  EXPECT_EQ(faults("force"), 1) << "one push, one fault";
  push(lower, 0.28);  // not below nine tenths: the same push
  show();
  push(lower, 0.31);
  for (int i = 0; i < 4; ++i) show();
  EXPECT_EQ(faults("force"), 1);
  push(lower, 0.2);
  show();
  push(lower, 0.31);
  for (int i = 0; i < 4; ++i) show();
  EXPECT_EQ(faults("force"), 2);
}

TEST_F(Rules, ForceIsThatOfOneHandOnOneBody) {
  push(lower, 0.2, 0.2);
  for (int i = 0; i < 5; ++i) show();
  EXPECT_EQ(faults("force"), 0) << "two hands, each below the limit";
  push(upper, 0, 0.31);
  for (int i = 0; i < 5; ++i) show();
  EXPECT_EQ(faults("force"), 1) << "the left hand counts as the right one";
  push(nullptr, 0);
  ContactPoint between;
  between.a = lower, between.b = upper, between.normal = Vec3::UnitZ(), between.normal_force = 5;
  report.contacts = {between};
  for (int i = 0; i < 5; ++i) show();
  EXPECT_EQ(faults("force"), 1) << "tissue on tissue is nobody's fault";
}

TEST_F(Rules, TwoHandsMustWorkTogether) {
  const auto cut = [&](int hand, int times = 1) {
    report.events.assign(std::size_t(times), {"strand_cut", "strands", "", 0.03, 1, hand});
    show();
    report.events.clear();
  };
  const auto rest = [&] {
    push(lower, 0);
    for (int i = 0; i < 10; ++i) show();  // as long as a pause is forgiven
  };
  cut(1, 10);
  EXPECT_FALSE(goal("together").done) << "nobody holds tissue";
  push(lower, 0.1);
  cut(1, 10);
  EXPECT_FALSE(goal("together").done) << "the cutting hand itself presses";
  rest();
  push(lower, 0, 0.1);
  cut(0, 10);
  EXPECT_FALSE(goal("together").done) << "the hand that holds is the one that cuts";
  rest();
  push(lower, 0, 0.01);
  cut(1, 10);
  EXPECT_FALSE(goal("together").done) << "a touch is no hold";
  push(lower, 0, 0.1);
  cut(1);
  EXPECT_FALSE(goal("together").done) << "one of two";
  rest();
  cut(1);
  EXPECT_FALSE(goal("together").done) << "let go half a second ago";
  push(lower, 0, 0.1);
  show();
  push(lower, 0);
  show();
  cut(1);
  EXPECT_TRUE(goal("together").done) << "a short pause is forgiven";
}

TEST_F(Rules, TornStrandsCountAndCutOnesDoNot) {
  report.events = {{"strand_cut", "strands", "", 0.03, 1},
                   {"strand_torn", "strands", "", 0.05, 1},
                   {"strand_torn", "strands", "", 0.06, 1}};
  show();
  EXPECT_EQ(faults("torn"), 2);
  EXPECT_EQ(faults("parted"), 1) << "the event that <fault_event> names";
  report.events.clear();
  show();
  EXPECT_EQ(faults("torn"), 2);
  EXPECT_EQ(faults("parted"), 1);
}

TEST_F(Rules, TwoHandsFailWhenTheyAreOutOfReach) {
  report.channels.assign(s->channels().numbers(), std::nan(""));
  double& standing = report.channels[s->channels().find("strands.standing")->offset];
  push(lower, 0, 0.1);
  standing = 2;
  show();
  report.events = {{"strand_cut", "strands", "", 0.03, 1, 1}};
  standing = 1;
  show();
  EXPECT_EQ(s->exercise()->log().state(), ExerciseState::running) << "one was cut, and one is left";
  push(lower, 0, 0);
  report.events.clear();
  standing = 0;
  show();
  EXPECT_EQ(s->exercise()->log().state(), ExerciseState::failed);
  EXPECT_EQ(
      s->exercise()->log().last_message(),
      "Out of reach: 1 of 2 were done, and 0 are left. Begin again: Divide two strands while the other hand holds "
      "a block");
}

TEST_F(Rules, OrderForgivesNeighboursAndAFewThatStand) {
  strands(5);  // at 0, 3, 6, 9, 12 mm
  show();
  part({1});  // 0 stands before it, but within the margin
  show();
  EXPECT_EQ(faults("order"), 0);
  part({2});  // 0 stands 6 mm nearer to the surface: one is allowed
  show();
  EXPECT_EQ(faults("order"), 0);
  part({4});  // 0 stands, and 3 within the margin
  show();
  EXPECT_EQ(faults("order"), 0);
  show();
  EXPECT_EQ(all_faults(), 0);
}

TEST_F(Rules, OrderCountsAStrandPartedInTheDepth) {
  strands(5);
  show();
  part({4});  // 0, 1, 2 stand 12, 9 and 6 mm nearer to the surface
  show();
  EXPECT_EQ(faults("order"), 1);
  show();
  EXPECT_EQ(faults("order"), 1) << "once a strand";
  for (StrandState& t : fake->strands) t.a.x() = t.b.x() = -t.a.x();  // depth is that of the start
  part({3});
  show();
  EXPECT_EQ(faults("order"), 2);
}

TEST_F(Rules, TimeLimitEndsTheExercise) {
  report.time = 59.9;
  show();
  EXPECT_EQ(s->exercise()->log().state(), ExerciseState::running);
  report.time = 60.0;
  show();
  EXPECT_EQ(s->exercise()->log().state(), ExerciseState::failed);
  push(lower, 1);
  for (int i = 0; i < 5; ++i) show();
  EXPECT_EQ(faults("force"), 0) << "nothing counts after the end";
}

TEST_F(Rules, AllGoalsReachedIsTheEnd) {
  strands(2);
  part({0, 1});
  for (int i = 0; i < upper->nodes(); ++i) upper->q()[3 * i + 2] += 0.01;
  push(lower, 0, 0.1);
  report.events.assign(2, {"strand_cut", "strands", "", 0.03, 1, 1});
  for (int i = 0; i < 6; ++i) show();
  EXPECT_EQ(s->exercise()->log().state(), ExerciseState::done);
  EXPECT_NEAR(s->exercise()->log().end_time(), goal("open").time, 1e-12);
}

TEST_F(Rules, ResetForgetsEverything) {
  strands(5);
  show();
  part({4});
  push(lower, 0.31);
  report.events = {{"strand_torn", "strands", "", 0.05, 1}};
  for (int i = 0; i < 3; ++i) show();
  ASSERT_GE(faults("force"), 1);
  ASSERT_GE(faults("torn"), 1);
  ASSERT_GE(faults("order"), 1);
  s->reset();
  EXPECT_EQ(all_faults(), 0);
  report.events.clear();
  push(lower, 0.31);
  strands(5);
  for (int i = 0; i < 2; ++i) show();
  EXPECT_EQ(all_faults(), 0) << "the time of a push before the reset must not count";
}

TEST(RulesOfAScene, TwoHandsNeedAnEventAndOneSignOfTheOther) {
  const auto messages = [](const std::string& attributes) {
    return load_simulation_text(R"(<scene><obstacle id="floor"/><exercise id="e" title="t"><goal_two_hands id="g" )" +
                                    attributes + "/></exercise></scene>",
                                example, test::builtin())
        .diagnostics.format();
  };
  EXPECT_NE(messages(R"(event="strand_cut" on="floor")").find("no component of the scene has the event"),
            std::string::npos);
  EXPECT_NE(
      load_simulation_text(
          R"(<scene><exercise id="e" title="t"><fault_event id="f" text="t" event="strand_cut"/></exercise></scene>)",
          example, test::builtin())
          .diagnostics.format()
          .find("no component of the scene has the event"),
      std::string::npos);
  EXPECT_NE(messages(R"(event="strand_cut")").find(R"(needs either "on" or "channel")"), std::string::npos);
}

TEST(RulesOfAScene, ZeroDirectionIsAnError) {
  const auto loaded = load_simulation_text(
      "<scene><exercise id=\"e\" title=\"t\"><fault_order id=\"o\" inward=\"0 0 0\"/></exercise></scene>", example,
      test::builtin());
  EXPECT_FALSE(loaded.simulation);
  EXPECT_NE(loaded.diagnostics.format().find("a direction must not be zero"), std::string::npos)
      << loaded.diagnostics.format();
}

}  // namespace
}  // namespace insula
