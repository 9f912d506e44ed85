// SPDX-License-Identifier: GPL-3.0-or-later
// Hints on channels, rules and metrics: when the cue comes, what it says, and what is said of wrong names and units.
#include <gtest/gtest.h>

#include <algorithm>

#include "core/registry/registry.h"
#include "core/sim/simulation.h"
#include "core/sim/tutor.h"
#include "core/testing/example.h"

namespace insula {
namespace {

class HintGauge final : public Constraint {
 public:
  Channel<Force> tension{this, {.name = "tension", .doc = "for tests", .display = "mN", .digits = 0}};
  void build(const StepContext&, ConstraintBuilder&) override {}
  void publish() override { tension.set(value); }
  double value = 0;
};

constexpr double time_step = 0.01;

struct HintBench {
  Registry registry;
  SimulationResult loaded;
  HintGauge* gauge = nullptr;
  std::vector<Event> hints;
  explicit HintBench(const std::string& rules) {
    register_builtin(registry);
    registry.add<HintGauge>("gauge", Kind::constraint, "for tests");
    loaded = load_simulation_text(
        "<scene time_step=\"10 ms\"><gauge id=\"g\"/><exercise title=\"E\">\n" + rules + "</exercise></scene>",
        INSULA_SOURCE_DIR "/plugins/hints/s.xml", registry, 1);
    if (loaded.simulation) gauge = loaded.simulation->scene().find_as<HintGauge>("g");
  }
  std::string messages() const { return loaded.diagnostics.format(); }
  Simulation& s() const { return *loaded.simulation; }
  void hold(double newtons, int steps) {
    gauge->value = newtons;
    for (int i = 0; i < steps; ++i) {
      s().step();
      for (const Event& e : s().events())
        if (e.kind == "hint") hints.push_back(e);
    }
  }
  const GivesCues& tutor() const { return *tutor_of(*s().exercise()); }
};

constexpr const char* guarded =
    R"(<fault_channel id="tight" text="Too tight" channel="g.tension" limit="200 mN" grace="0.1 s"/>
  <hint_rule id="slacken" text="Slacken it" rule="tight" warning="0.7" at="left"/><tutor/>)";

TEST(Hints, TheCueComesWithinAFifthOfASecondOfItsCauseAndBeforeTheFault) {
  HintBench b(guarded);
  ASSERT_TRUE(b.gauge) << b.messages();
  b.hold(0.139, 50);
  EXPECT_TRUE(b.hints.empty());
  const double caused = b.s().time();
  b.hold(0.16, 30);
  ASSERT_EQ(b.hints.size(), 1u);
  EXPECT_LE(b.hints[0].time - caused, 2 * time_step + 1e-9) << "s";
  EXPECT_EQ(b.hints[0].id, "slacken");
  EXPECT_EQ(b.hints[0].text, "Slacken it");
  EXPECT_EQ(b.hints[0].hand, 0);
  EXPECT_NEAR(b.hints[0].value, 0.8, 1e-12);
  EXPECT_EQ(b.s().exercise()->log().faults()[0].count, 0);
}

TEST(Hints, ACueSaysWhatCameNearWhichLimit) {
  HintBench b(guarded);
  ASSERT_TRUE(b.gauge) << b.messages();
  b.hold(0.16, 10);
  ASSERT_EQ(b.tutor().cues().size(), 1u);
  const HintCause& cause = b.tutor().cues()[0].cause;
  EXPECT_EQ(cause.watched, "g.tension");
  EXPECT_EQ(cause.value, "160 mN");
  EXPECT_EQ(cause.limit, "200 mN");
  EXPECT_TRUE(cause.holds);
  b.s().reset();
  EXPECT_TRUE(b.tutor().cues().empty());
}

TEST(Hints, CausesAreRankedAndOneCueComesInTenSeconds) {
  HintBench b(R"(<tutor id="t"/><time_limit limit="60 s"/>
    <hint_channel id="a" text="A" channel="g.tension" limit="0.3 N" warning="0.5"/>
    <hint_channel id="b" text="B" channel="g.tension" limit="0.2 N" warning="0.5"/>
    <hint_channel id="c" text="C" channel="g.tension" comparison="below" limit="0.1 N"/>)");
  ASSERT_TRUE(b.gauge) << b.messages();
  b.hold(0.25, 2200);
  const auto causes = b.tutor().causes();
  ASSERT_EQ(causes.size(), 2u);
  EXPECT_EQ(causes[0].id, "b");
  EXPECT_NEAR(causes[0].share, 1.25, 1e-12);
  EXPECT_EQ(causes[1].id, "a");
  ASSERT_EQ(b.hints.size(), 2u) << "each one once";
  EXPECT_EQ(b.hints[0].id, "b");
  EXPECT_EQ(b.hints[1].id, "a");
  EXPECT_NEAR(b.hints[1].time - b.hints[0].time, 10, 1e-6);
  b.hold(0.05, 1200);
  ASSERT_EQ(b.hints.size(), 3u);
  EXPECT_EQ(b.hints[2].id, "c");
}

TEST(Hints, NothingIsSaidAfterTheEnd) {
  HintBench b(R"(<goal_channel text="Pull" channel="g.tension" limit="0.1 N"/><tutor/>
    <hint_channel text="A" channel="g.tension" limit="0.2 N"/>)");
  ASSERT_TRUE(b.gauge) << b.messages();
  b.hold(0.15, 2);
  ASSERT_EQ(b.s().exercise()->log().state(), ExerciseState::done);
  b.hold(0.5, 100);
  EXPECT_TRUE(b.hints.empty());
}

TEST(Hints, WrongNamesAndUnitsAreLocatedErrors) {
  const auto said = [](const std::string& rules) { return HintBench(rules).messages(); };
  const auto has = [](const std::string& text, const std::string& part) {
    EXPECT_NE(text.find(part), std::string::npos) << text;
  };
  has(said(R"(<tutor/><hint_channel text="T" channel="g.tensoin" limit="1 N"/>)"), "did you mean \"g.tension\"?");
  has(said(R"(<tutor/><hint_channel text="T" channel="g.tension" limit="1 mmHg"/>)"), "s.xml:2:");
  has(said(R"(<tutor/><hint_channel text="T" channel="g.tension" limit="0 N"/>)"), "must not be zero");
  has(said(R"(<hint_channel text="T" channel="g.tension" limit="1 N"/>)"), "needs a <tutor> in its exercise");
  has(said("<tutor/>"), "has no hint to give");
  has(said(std::string(guarded) + "<tutor/>"), "it has one already");
  has(said(R"(<tutor/><fault_channel id="tight" text="T" channel="g.tension" limit="1 N"/>
      <hint_rule text="T" rule="tigth"/>)"),
      "did you mean \"tight\"?");
  has(said(R"(<tutor/><hint_metric text="T" metric="path_length" of="right" bands="example_bands.json"/>)"),
      "the exercise has no single metric \"path_length\"");
  has(said(
          R"(<tutor/><hand_metrics/><hint_metric text="T" metric="path_length" of="left" bands="example_bands.json"/>)"),
      "the file of bands has none of it for left");
}

TEST(Hints, OfTheExampleComeBeforeTheFaultAndWhenTheBandIsLeft) {
  auto s = test::load(INSULA_SOURCE_DIR "/plugins/hints/example.xml");
  ASSERT_TRUE(s && s->exercise());
  double fault = -1;
  for (int i = 0; i < 900 && s->exercise()->log().state() == ExerciseState::running; ++i) {
    test::run_script(*s, 1);
    for (const Event& e : s->events())
      if (e.kind == "fault" && fault < 0) fault = e.time;
  }
  const std::vector<Cue>& cues = tutor_of(*s->exercise())->cues();
  ASSERT_FALSE(cues.empty());
  std::string all;
  for (const Cue& c : cues) all += c.cause.id + " at " + std::to_string(c.time) + " s: " + c.cause.value + "\n";
  const auto of = [&](const std::string& id) {
    return std::find_if(cues.begin(), cues.end(), [&](const Cue& c) { return c.cause.id == id; });
  };
  ASSERT_NE(of("ease_off"), cues.end()) << all << "fault at " << fault;
  EXPECT_EQ(of("ease_off")->cause.hand, 1);
  ASSERT_GT(fault, 0) << "the script of the example presses hard";
  EXPECT_LE(of("ease_off")->time, fault - 0.1);
  ASSERT_NE(of("shorter_ways"), cues.end()) << all;
  EXPECT_EQ(of("shorter_ways")->cause.limit, "5 mm");
  EXPECT_GE(of("shorter_ways")->cause.share, 1);
}

}  // namespace
}  // namespace insula
