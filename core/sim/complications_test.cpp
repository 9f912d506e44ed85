// SPDX-License-Identifier: GPL-3.0-or-later
// Complications: the draw follows from the seed alone, the commands come at their times, mistakes are named.
#include "core/sim/complications.h"

#include <gtest/gtest.h>

#include <cmath>

#include "core/mechanics/constraint.h"
#include "core/registry/registry.h"
#include "core/sim/simulation.h"

namespace insula {
namespace {

/// Something that can be asked for.
class Bell final : public Constraint {
 public:
  std::vector<CommandInfo> commands() const override {
    return {{"ring", "rings it", "", 0, 0}, {"tune", "tunes it", "frequency_Hz", 20, 2000}};
  }
  std::string run_command(std::string_view name, std::string_view argument) override {
    if (name == "tune" && argument != "440") return "out of tune";
    ++rung;
    return {};
  }
  void connect(PrepareContext&, Simulation&) override {}
  void build(const StepContext&, ConstraintBuilder&) override {}
  void finish(const StepContext&, const ConstraintSolution&) override {}
  void reset() override { rung = 0; }
  void append_state(std::vector<double>& out) const override { out.push_back(rung); }
  int rung = 0;
};

SimulationResult load(const std::string& inside) {
  Registry registry;
  register_builtin(registry);
  registry.add<Bell>("bell", Kind::constraint, "for tests");
  return load_simulation_text(
      "<scene time_step=\"10 ms\" seed=\"7\"><bell id=\"big\"/><bell id=\"small\"/>" + inside + "</scene>",
      "/scene.xml", registry, 1);
}

const std::string three = R"(
  <complication id="a" command="big ring" probability="0.5" from="1 s" to="3 s"/>
  <complication id="b" command="small tune 440" from="0.5 s" to="0.5 s"/>
  <complication id="never" command="big ring" probability="0" to="1 s"/>)";

TEST(Complications, SameSeedSameDraw) {
  const auto first = load("<complications>" + three + "</complications>"),
             second = load("<complications seed=\"7\">" + three + "</complications>");
  ASSERT_TRUE(first.simulation && second.simulation) << first.diagnostics.format();
  const Complications &x = *first.simulation->complications(), &y = *second.simulation->complications();
  EXPECT_EQ(x.drawn_from(), 7u);  // the scene's
  EXPECT_EQ(y.drawn_from(), 7u);
  ASSERT_EQ(x.drawn().size(), 3u);
  for (std::size_t i = 0; i < 3; ++i) {
    EXPECT_EQ(x.drawn()[i].time, y.drawn()[i].time);
    EXPECT_EQ(x.drawn()[i].happens, y.drawn()[i].happens);
  }
}

TEST(Complications, OneMoreChangesNoneOfTheOthers) {
  const auto few = load("<complications>" + three + "</complications>");
  const auto more = load("<complications><complication id=\"first\" command=\"small ring\" to=\"9 s\"/>" + three +
                         "</complications>");
  ASSERT_TRUE(few.simulation && more.simulation);
  for (std::size_t i = 0; i < 3; ++i)
    EXPECT_EQ(few.simulation->complications()->drawn()[i].time, more.simulation->complications()->drawn()[i + 1].time);
}

// Probability 1/2: of 2,000 seeds 1,000 +- 4 standard deviations (22); times uniform on [1, 3]: mean 2 +- 4 * 0.577 /
// sqrt(2000).
TEST(Complications, DrawsAreAsLikelyAsTheySay) {
  auto loaded = load("<complications>" + three + "</complications>");
  ASSERT_TRUE(loaded.simulation);
  int happened = 0;
  double sum = 0;
  for (std::uint64_t seed = 1; seed <= 2000; ++seed) {
    loaded.simulation->draw_complications(seed);
    const auto& d = loaded.simulation->complications()->drawn();
    happened += d[0].happens;
    sum += d[0].time;
    EXPECT_GE(d[0].time, 1);
    EXPECT_LE(d[0].time, 3);
    EXPECT_TRUE(d[1].happens);
    EXPECT_FALSE(d[2].happens);
  }
  EXPECT_NEAR(happened, 1000, 4 * 22.4);
  EXPECT_NEAR(sum / 2000, 2, 4 * 0.577 / std::sqrt(2000.0));
}

TEST(Complications, ComeAtTheirTimesOnceAndAgainAfterAReset) {
  auto loaded = load("<complications>" + three + "</complications>");
  ASSERT_TRUE(loaded.simulation);
  Simulation& s = *loaded.simulation;
  std::uint64_t seed = 1;
  for (;; ++seed) {
    s.draw_complications(seed);
    if (s.complications()->drawn()[0].happens) break;
  }
  auto *big = s.scene().find_as<Bell>("big"), *small = s.scene().find_as<Bell>("small");
  std::uint64_t hash[2];
  for (int round = 0; round < 2; ++round) {
    s.reset();
    EXPECT_EQ(s.complications()->drawn_from(), seed);
    const double due = s.complications()->drawn()[0].time;
    std::vector<Event> events;
    for (int k = 0; k < 320; ++k) {
      const double start = s.time();
      s.step();
      EXPECT_EQ(big->rung, start >= due - 1e-9 ? 1 : 0) << start;
      EXPECT_EQ(small->rung, start >= 0.5 - 1e-9 ? 1 : 0) << start;
      events.insert(events.end(), s.events().begin(), s.events().end());
    }
    ASSERT_EQ(events.size(), 4u);
    EXPECT_EQ(events[0].kind, "complication");
    EXPECT_EQ(events[0].id, "b");
    EXPECT_NEAR(events[0].time, 0.5, 1e-9);
    EXPECT_EQ(events[1].kind, "command");
    EXPECT_EQ(events[1].text, "small tune 440");
    EXPECT_EQ(events[2].id, "a");
    EXPECT_TRUE(s.complications()->drawn()[0].begun);
    EXPECT_EQ(s.complications()->drawn()[0].refused, "");
    hash[round] = s.state_hash();
  }
  EXPECT_EQ(hash[0], hash[1]);
}

TEST(Complications, ARefusedOneSaysWhy) {
  auto loaded = load(R"(<complications><complication id="c" command="big tune 20" to="0 s"/></complications>)");
  ASSERT_TRUE(loaded.simulation);
  loaded.simulation->step();
  EXPECT_EQ(loaded.simulation->complications()->drawn()[0].refused, "out of tune");
  ASSERT_EQ(loaded.simulation->events().size(), 2u);
  EXPECT_EQ(loaded.simulation->events()[1].kind, "refused");
}

TEST(Complications, NothingHappensWhileTheSceneSettles) {
  auto loaded =
      load(R"(<settle time="1 s"/><complications><complication id="c" command="big ring" to="0 s"/></complications>)");
  ASSERT_TRUE(loaded.simulation) << loaded.diagnostics.format();
  auto* big = loaded.simulation->scene().find_as<Bell>("big");
  EXPECT_EQ(big->rung, 0);
  loaded.simulation->step();
  EXPECT_EQ(big->rung, 1);
}

TEST(Complications, MistakesAreNamed) {
  const std::pair<std::string, std::string> bad[] = {
      {R"(<complications><complication command="bgi ring" to="1 s"/></complications>)",
       "command: no component has the id \"bgi\"; did you mean \"big\"?"},
      {R"(<complications><complication command="big rnig" to="1 s"/></complications>)",
       "command: <bell> has no command \"rnig\"; did you mean \"ring\"?"},
      {R"(<complications><complication command="big" to="1 s"/></complications>)",
       "command: needs the id of a component and one of its commands"},
      {R"(<complications><complication command="big ring" from="2 s" to="1 s"/></complications>)",
       "to: comes before from"},
      {R"(<complications><complication command="big ring" probability="1.2" to="1 s"/></complications>)",
       "is outside the allowed range"},
      {R"(<complications/><complications/>)", "may stand only once"},
      {R"(<complication command="big ring" to="1 s"/>)", "<complication> may not stand in <scene>"},
  };
  for (const auto& [text, expected] : bad) {
    const auto loaded = load(text);
    EXPECT_FALSE(loaded.simulation) << text;
    EXPECT_NE(loaded.diagnostics.format().find(expected), std::string::npos) << loaded.diagnostics.format();
  }
}

}  // namespace
}  // namespace insula
