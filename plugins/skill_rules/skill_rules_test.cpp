// SPDX-License-Identifier: GPL-3.0-or-later
// The goals of skill tasks against step reports made by hand: whose turn it is, what counts, and what begins afresh.
#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>

#include "core/model/formats/file_bytes.h"
#include "core/testing/example.h"

namespace insula {
namespace {

const std::filesystem::path example = std::filesystem::path(INSULA_SOURCE_DIR) / "plugins/skill_rules/example.xml";

/// The example scene; its exercise is shown reports instead of steps.
class SkillRules : public ::testing::Test {
 protected:
  void SetUp() override {
    s = test::load(example);
    ASSERT_TRUE(s && s->exercise());
    report.h = 0.05;
    report.structures = s->report().structures;
    report.channels.assign(s->channels().numbers(), std::nan(""));
    for (std::size_t i = 0; i < 2; ++i) report.hands[i].tool = s->instruments()[i];
    place(0, Vec3(0, 0, 0.1));
    place(1, Vec3(0, 0, 0.1));
  }
  void place(std::size_t hand, const Vec3& tip) { report.hands[hand].tip.p = tip; }
  void push(std::size_t hand, double newton) { report.structures[0].of_hand[hand] = Vec3(0, 0, -newton); }
  void show(int times) {
    for (int i = 0; i < times; ++i) {
      report.time += report.h;
      s->exercise()->observe(report);
    }
  }
  bool done(std::size_t goal) const { return s->exercise()->log().goals()[goal].done; }
  /// Number of marks of one kind: waiting, left, right, reached.
  int marks(const char* goal, const char* kind) {
    Component* rule = s->scene().find(goal);
    rule->publish();
    for (const DrawableBase* d : rule->drawables())
      if (d->spec().name == kind) return d->count();
    throw std::runtime_error(std::string("no drawable ") + kind);
  }
  double unheld(const char* goal) {
    Component* rule = s->scene().find(goal);
    rule->publish();
    for (const ChannelBase* c : rule->channels())
      if (c->spec().name == "unheld") return *c->values(0);
    throw std::runtime_error("no channel unheld");
  }
  double metric(const std::string& id, int hand) {
    for (const MetricValue& m : s->exercise()->metrics())
      if (m.id == id && m.hand == hand) return m.known ? m.value : std::nan("");
    throw std::runtime_error("no metric " + id);
  }
  /// Reaches the first goal.
  void touch() {
    place(0, Vec3(-0.005, 0, 0.004));
    push(1, 0.01);
    show(4);
  }

  std::unique_ptr<Simulation> s;
  StepReport report;
};

TEST_F(SkillRules, TheTargetWantsItsHandItsTimeAndTheOtherHandsHold) {
  const Vec3 near(-0.005, 0.001, 0.004);
  push(1, 0.01);
  place(1, near);
  show(10);
  EXPECT_FALSE(done(0)) << "the other hand's tip";
  place(1, Vec3(0, 0, 0.1));
  place(0, Vec3(-0.005, 0.0013, 0.004));
  show(10);
  EXPECT_FALSE(done(0)) << "1.3 mm away";
  place(0, near);
  push(1, 0.004);
  show(10);
  EXPECT_FALSE(done(0)) << "the other hand holds too little";
  EXPECT_EQ(unheld("target"), 1) << "which is told";
  push(1, 0.01);
  show(1);
  EXPECT_EQ(unheld("target"), 0);
  place(0, Vec3(0, 0, 0.1));
  push(1, 0);
  show(1);
  EXPECT_EQ(unheld("target"), 0) << "away from the target nothing need be held";
  place(0, near);
  push(1, 0.01);
  show(3);
  EXPECT_FALSE(done(0)) << "0.15 s of 0.2 s";
  push(1, 0);
  show(1);
  push(1, 0.01);
  show(3);
  EXPECT_FALSE(done(0)) << "the time begins afresh";
  show(1);
  EXPECT_TRUE(done(0));
  EXPECT_NEAR(metric("touch_error", left_hand), 1, 1e-9) << "mm";
  EXPECT_TRUE(std::isnan(metric("touch_error", right_hand)));
}

TEST_F(SkillRules, TheForceMustStayInItsBandAtItsPlace) {
  place(1, Vec3(0.005, 0, 0));
  push(1, 0.08);
  show(20);
  EXPECT_FALSE(done(1)) << "before its turn";
  touch();
  place(1, Vec3(0.005, 0, 0));
  push(1, 0.049);
  show(20);
  EXPECT_FALSE(done(1)) << "too little";
  push(1, 0.101);
  show(20);
  EXPECT_FALSE(done(1)) << "too much";
  push(1, 0.08);
  place(1, Vec3(0.005, 0.0041, 0));
  show(20);
  EXPECT_FALSE(done(1)) << "beside the place";
  place(1, Vec3(0.005, 0, -0.002));
  push(0, 0.08);
  push(1, 0);
  show(20);
  EXPECT_FALSE(done(1)) << "the other hand";
  push(1, 0.08);
  show(9);
  EXPECT_FALSE(done(1)) << "0.45 s of 0.5 s";
  show(1);
  EXPECT_TRUE(done(1));
  EXPECT_NEAR(metric("force_error", right_hand), 5, 1e-9) << "mN from 75 mN";
}

TEST_F(SkillRules, MarksShowWhoseTurnItIs) {
  EXPECT_EQ(marks("target", "left"), 1);
  EXPECT_EQ(marks("target", "right"), 0);
  EXPECT_EQ(marks("press", "waiting"), 1);
  EXPECT_EQ(marks("press", "right"), 0);
  touch();
  EXPECT_EQ(marks("target", "left"), 0);
  EXPECT_EQ(marks("target", "reached"), 1);
  EXPECT_EQ(marks("press", "waiting"), 0);
  EXPECT_EQ(marks("press", "right"), 1);
  EXPECT_EQ(marks("press", "held"), 0) << "nothing is held yet";
  place(1, Vec3(0.005, 0, 0));
  push(1, 0.08);
  show(5);
  EXPECT_EQ(marks("press", "held"), 1) << "half of the hold";
  EXPECT_EQ(marks("press", "reading"), 1);
  show(5);
  EXPECT_EQ(marks("press", "reached"), 1);
  EXPECT_EQ(marks("press", "held"), 0);
  EXPECT_EQ(marks("press", "reading"), 0);
}

TEST_F(SkillRules, PlacesAreOpenUntilTheirGoalIsReached) {
  const auto style = [&](const DrawableBase& d) {
    for (const Material& m : s->scene().materials())
      if (m.name == d.spec().material) return m.style;
    return std::string("none");
  };
  for (const char* goal : {"target", "press"})
    for (const DrawableBase* d : s->scene().find(goal)->drawables())
      if (const std::string name(d->spec().name); name == "waiting" || name == "left" || name == "right")
        EXPECT_EQ(style(*d), "place") << goal << '.' << name;
      else EXPECT_NE(style(*d), "place") << goal << '.' << name;
}

/// The example's clip is free. Its blades, 9 mm long, point down from z = 13 mm at y = 5 mm.
TEST(ClipPlaced, CountsItsPlaceAndThatItIsSquare) {
  const auto outcome = [](const std::string& at, const std::string& axis) {
    std::string text = read_file_bytes(example);
    const auto set = [&](const std::string& from, const std::string& to) {
      text.replace(text.find(from), from.size(), to);
    };
    set("at=\"0 5 8 mm\"", "at=\"" + at + "\"");
    set("axis=\"1 0 0\"", "axis=\"" + axis + "\"");
    auto s = test::load_text(text, example);
    if (!s) return std::pair(-1, -1);
    for (int i = 0; i < 14; ++i) s->step();
    const ExerciseLog& log = s->exercise()->log();
    return std::pair(int(log.goals().back().done), log.faults().front().count);
  };
  EXPECT_EQ(outcome("0 5 8 mm", "1 0 0"), std::pair(1, 0));
  EXPECT_EQ(outcome("0 5 5 mm", "0 1 0.2"), std::pair(1, 0)) << "11 degrees from square";
  EXPECT_EQ(outcome("0 5 5 mm", "0 1 0.5"), std::pair(0, 1)) << "27 degrees from square";
  EXPECT_EQ(outcome("1.1 5 8 mm", "1 0 0"), std::pair(0, 1)) << "1.1 mm beside the mark";
  EXPECT_EQ(outcome("0 5 2 mm", "1 0 0"), std::pair(0, 1)) << "beyond the tips";
}

TEST_F(SkillRules, ResetForgetsEverything) {
  touch();
  ASSERT_TRUE(done(0));
  s->reset();
  EXPECT_FALSE(done(0));
  EXPECT_EQ(marks("target", "left"), 1);
  EXPECT_TRUE(std::isnan(metric("touch_error", left_hand)));
  show(3);
  EXPECT_FALSE(done(0)) << "the time before the reset must not count";
}

TEST(SkillRulesOfAScene, MistakesAreErrorsAtTheirPlace) {
  const auto messages = [](const std::string& goals) {
    return load_simulation_text(
               R"(<scene><obstacle id="floor"/><exercise id="e" title="t">)" + goals + "</exercise></scene>", example,
               test::builtin())
        .diagnostics.format();
  };
  const std::string a = R"(<goal_touch id="a" text="t" hand="left" at="0 0 0 mm" after="b"/>)";
  const std::string b = R"(<goal_touch id="b" text="t" hand="left" at="0 0 0 mm" after="a"/>)";
  EXPECT_NE(messages(a + b).find("comes after itself"), std::string::npos);
  EXPECT_NE(
      messages(R"(<goal_hold_force id="f" text="t" hand="left" at="0 0 0 mm" on="floor" least="2 N" most="1 N"/>)")
          .find("must be above least"),
      std::string::npos);
}

}  // namespace
}  // namespace insula
