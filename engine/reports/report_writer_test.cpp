// SPDX-License-Identifier: GPL-3.0-or-later
// The report of a run: keys, numbers, plots and a page that is well-formed whatever the texts hold.
#include "engine/reports/report_writer.h"

#include <expat.h>
#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <limits>
#include <nlohmann/json.hpp>
#include <random>

#include "core/base/input_error.h"
#include "core/registry/registry.h"
#include "core/sim/simulation.h"
#include "engine/reports/svg_plot.h"

namespace insula {
namespace {

using Json = nlohmann::json;

std::string xml_error(const std::string& text) {
  XML_Parser parser = XML_ParserCreate(nullptr);
  std::string error;
  if (XML_Parse(parser, text.data(), int(text.size()), 1) != XML_STATUS_OK)
    error = std::string(XML_ErrorString(XML_GetErrorCode(parser))) + " in line " +
            std::to_string(XML_GetCurrentLineNumber(parser));
  XML_ParserFree(parser);
  return error;
}

/// Publishes the same every time: how many of `total` are left after k, a vector, a pressure of a and none of b.
class Gauge final : public Component {
 public:
  explicit Gauge(double all = 10) : total(all) {
    id = "g";
    pressure.declare({"a", "b"});
    pressure.set(0, 10665.790993);
    table.collect({this});
  }
  void show(double k, StepReport& r) {
    left.set(total - k);
    pull.set(Vec3(k, 2 * k, 3 * k));
    table.read(r.channels);
    r.channel_table = &table;
  }
  Channel<Scalar> left{this, {.name = "left", .doc = "for tests", .digits = 0}};
  Channel<Vec<Force>> pull{this, {.name = "pull", .doc = "for tests"}};
  ChannelGroup<Pressure> pressure{
      this, {.name = "pressure", .doc = "for tests", .shown = Shown::vital, .display = "mmHg", .digits = 0}};
  double total;
  ChannelTable table;
};

/// 100 steps of 0.1 s; in step k (from 1): k rows, solve takes k ms, 10 left of which one goes every ten steps.
RunRecorder hundred_steps() {
  RunRecorder recorder;
  Gauge gauge;
  for (int k = 1; k <= 100; ++k) {
    StepReport r;
    r.time = 0.1 * k;
    r.h = 0.1;
    r.rows = k;
    r.contacts.resize(std::size_t(k % 3));
    r.solve.sweeps = 2 * k;
    r.solve.residual_N = 1e-6 * k;
    r.solve.residual_m = 1e-9 * k;
    gauge.show(k / 10, r);
    r.stage_ms[stage_solve] = k;
    r.step_ms = k + 1;
    ToolReport tool;
    tool.hand = 1;
    tool.contact_force = k == 50 ? 2.5 : 0.5;
    r.tools.push_back(tool);
    std::vector<Event> events;
    if (k % 10 == 0) events.push_back({"strand_cut", "s", "", 1, r.time});
    if (k == 70) events.push_back({"fault", "force", "Too much <force> & \"more\"", 2.5, r.time});
    recorder.record(r, events, {0.1, k == 30 ? 1.5 : 0.2}, 1e-3);
  }
  return recorder;
}

RunSummary summary(const Exercise* exercise) {
  RunSummary s;
  s.title = "A <title> & more";
  s.scene = "scenes/a.xml";
  s.motion = "steady";
  s.wall_seconds = 2;
  s.fresh_forces_per_s = 991.5;
  s.max_force_N = {0.25, 1.75};
  s.state_hash = 0xfedcba9876543210ull;
  if (exercise) s.exercise.emplace(*exercise);
  return s;
}

void fill(Exercise& exercise) {
  exercise.id = "fissure";
  exercise.log().add_goal("open", "Open it");
  exercise.log().add_goal("all", "Divide all", false);
  exercise.log().add_fault("force", "Too much <force>");
  exercise.log().fault(0, 3.0, 2.5);
  exercise.log().goal(0, 4.5);  // the last required one: that is the end
}

TEST(ReportWriter, AnExerciseHasAGuideIfAnyOfItsMotionsIsOne) {
  for (std::size_t motions = 0; motions < 4; ++motions) {
    Exercise exercise;
    for (std::size_t i = 0; i < motions; ++i) exercise.children.push_back(std::make_unique<MotionEntry>());
    EXPECT_FALSE(ExerciseOutcome(exercise).has_guide) << motions;
    if (motions == 0) continue;
    exercise.motions().back()->guide.set(true);
    EXPECT_TRUE(ExerciseOutcome(exercise).has_guide) << motions;
  }
}

TEST(ReportJson, HasEveryKeyWithItsNumber) {
  Exercise exercise;
  fill(exercise);
  const Json j = Json::parse(report_json(hundred_steps(), summary(&exercise)));
  EXPECT_EQ(j.at("steps"), 100);
  EXPECT_NEAR(j.at("sim_seconds").get<double>(), 10, 1e-5);
  EXPECT_EQ(j.at("wall_seconds"), 2);
  EXPECT_NEAR(j.at("real_time_factor").get<double>(), 5, 1e-5);
  for (const char* stage : {"free_motion", "collision", "build", "solve", "correct", "publish"})
    for (const char* part : {"p50", "p95"})
      EXPECT_TRUE(j.at("stage_ms").at(stage).at(part).is_number()) << stage << part;
  EXPECT_EQ(j.at("stage_ms").at("solve").at("p50"), 50);
  EXPECT_EQ(j.at("stage_ms").at("solve").at("p95"), 95);
  EXPECT_EQ(j.at("rows").at("mean"), 50.5);
  EXPECT_EQ(j.at("rows").at("max"), 100);
  EXPECT_EQ(j.at("contacts").at("mean"), 1);
  EXPECT_EQ(j.at("contacts").at("max"), 2);
  EXPECT_EQ(j.at("sweeps").at("mean"), 101);
  EXPECT_EQ(j.at("sweeps").at("max"), 200);
  EXPECT_NEAR(j.at("residual").at("p50").get<double>(), 50e-6, 1e-11);
  EXPECT_NEAR(j.at("residual").at("max").get<double>(), 100e-6, 1e-11);
  EXPECT_EQ(j.at("haptic").at("fresh_forces_per_s"), 991.5);
  EXPECT_EQ(j.at("haptic").at("max_force_N").at("left"), 0.25);
  EXPECT_EQ(j.at("haptic").at("max_force_N").at("right"), 1.75);
  const Json& e = j.at("exercise");
  EXPECT_EQ(e.at("goals").at(0).at("id"), "open");
  EXPECT_EQ(e.at("goals").at(0).at("done"), true);
  EXPECT_EQ(e.at("goals").at(0).at("time_s"), 4.5);
  EXPECT_EQ(e.at("goals").at(1).at("done"), false);
  EXPECT_TRUE(e.at("goals").at(1).at("time_s").is_null());
  EXPECT_EQ(e.at("faults").at(0).at("id"), "force");
  EXPECT_EQ(e.at("faults").at(0).at("count"), 1);
  EXPECT_EQ(j.at("state_hash"), "fedcba9876543210");
  EXPECT_EQ(j.at("events").size(), 11u);
  EXPECT_EQ(j.at("series").at("time_s").size(), 100u);
  EXPECT_EQ(j.at("series").at("tool_force_N").at("right").at(49), 2.5);
  EXPECT_EQ(j.at("series").at("channels").at("g.left").at(99), 0);
}

TEST(ReportJson, TellsOfChannelsAndCommands) {
  Exercise exercise;
  fill(exercise);
  exercise.log().add_timer("t", "Temporary clip", 2);
  exercise.log().add_measure("m", "Neck <remnant>", "%");
  exercise.log().timer(0, 3, true);
  exercise.log().timer(0, 1, false);
  exercise.log().measure(0, 12.5, -1);
  RunRecorder recorder;
  Gauge gauge;
  for (int k = 1; k <= 10; ++k) {
    StepReport r;
    r.time = 0.1 * k;
    r.h = 0.1;
    gauge.show(k, r);
    std::vector<Event> events;
    if (k == 4)
      events = {{"command", "ask", "applier load a", 0, 0.4},
                {"refused", "exchange", "draw the <instrument> out", 0, 0.4},
                {"message", "message", "well done", 0, 0.4}};
    recorder.record(r, events, {0, 0}, 1e-3);
  }
  const Json j = Json::parse(report_json(recorder, summary(&exercise)));
  const Json& left = j.at("channels").at("g.left");
  EXPECT_EQ(left.at("unit"), "");
  EXPECT_EQ(left.at("min"), 0);
  EXPECT_EQ(left.at("max"), 9);
  EXPECT_EQ(left.at("mean"), 4.5);
  EXPECT_EQ(left.at("last"), 0);
  EXPECT_EQ(j.at("channels").at("g.pull").at("max"), Json({10, 20, 30}));
  EXPECT_EQ(j.at("channels").at("g.pull").at("unit"), "N");
  EXPECT_NEAR(j.at("channels").at("g.a.pressure").at("last").get<double>(), 10665.790993, 1e-6);
  EXPECT_TRUE(j.at("channels").at("g.b.pressure").at("mean").is_null()) << "was never known";
  EXPECT_EQ(j.at("channels").size(), 4u);
  EXPECT_EQ(j.at("series").at("channels").at("g.left"), Json({9, 8, 7, 6, 5, 4, 3, 2, 1, 0}));
  ASSERT_EQ(j.at("commands").size(), 3u);
  EXPECT_EQ(j.at("commands").at(0).at("argument"), "applier load a");
  EXPECT_EQ(j.at("commands").at(1).at("done"), false);
  EXPECT_EQ(j.at("commands").at(1).at("refused"), "draw the <instrument> out");
  EXPECT_EQ(j.at("commands").at(2).at("command"), "message");
  EXPECT_EQ(j.at("exercise").at("timers").at(0).at("longest_s"), 3);
  EXPECT_EQ(j.at("exercise").at("timers").at(0).at("elapsed_s"), 1);
  EXPECT_EQ(j.at("exercise").at("measures").at(0).at("value"), 12.5);
  EXPECT_FALSE(j.contains("complications"));
  const std::string html = report_html(recorder, summary(&exercise));
  EXPECT_EQ(xml_error(html), "");
  for (const char* part :
       {"g at the end", "pressure (mmHg)", ">80<", "g: left", "refused: draw the &lt;instrument&gt; out",
        "Neck &lt;remnant&gt;", "12.5 %", "Temporary clip"})
    EXPECT_NE(html.find(part), std::string::npos) << part;
}

/// Something that can go wrong.
class Valve final : public Constraint {
 public:
  std::vector<CommandInfo> commands() const override { return {{"burst", "bursts", "", 0, 0}}; }
  std::string run_command(std::string_view, std::string_view) override {
    return burst_++ ? "it has burst already" : "";
  }
  void build(const StepContext&, ConstraintBuilder&) override {}
  void reset() override { burst_ = 0; }

 private:
  int burst_ = 0;
};

TEST(ReportJson, StatesTheSeedAndWhatWasDrawn) {
  Registry registry;
  register_builtin(registry);
  registry.add<Valve>("valve", Kind::constraint, "for tests");
  const auto loaded = load_simulation_text(R"(<scene time_step="10 ms"><valve id="v"/><complications seed="12">
  <complication id="one" command="v burst" from="0.05 s" to="0.05 s"/><complication id="two" command="v burst" from="0.1 s" to="0.1 s"/>
  <complication id="late" command="v burst" from="9 s" to="9 s"/><complication id="never" command="v burst" probability="0" to="1 s"/>
</complications></scene>)",
                                           "/s.xml", registry, 1);
  ASSERT_TRUE(loaded.simulation) << loaded.diagnostics.format();
  RunRecorder recorder;
  for (int k = 0; k < 20; ++k) {
    loaded.simulation->step();
    recorder.record(loaded.simulation->report(), loaded.simulation->events(), {0, 0}, loaded.simulation->energy());
  }
  RunSummary s = summary(nullptr);
  s.complications.emplace(*loaded.simulation->complications());
  const Json j = Json::parse(report_json(recorder, s));
  EXPECT_EQ(j.at("complications").at("seed"), 12);
  const Json& drawn = j.at("complications").at("drawn");
  ASSERT_EQ(drawn.size(), 4u);
  EXPECT_EQ(drawn.at(0).at("time_s"), 0.05);
  EXPECT_EQ(drawn.at(0).at("refused"), "");
  EXPECT_EQ(drawn.at(1).at("refused"), "it has burst already");
  EXPECT_EQ(drawn.at(2).at("happens"), true);
  EXPECT_EQ(drawn.at(2).at("begun"), false);
  EXPECT_EQ(drawn.at(3).at("happens"), false);
  EXPECT_TRUE(drawn.at(3).at("time_s").is_null());
  ASSERT_EQ(j.at("commands").size(), 2u);
  EXPECT_NEAR(j.at("commands").at(0).at("time_s").get<double>(), 0.05, 1e-9);
  const std::string html = report_html(recorder, s);
  EXPECT_EQ(xml_error(html), "");
  for (const char* part :
       {"Drawn from seed 12", "refused: it has burst already", "not in this run", "drawn for 9.0 s, not reached"})
    EXPECT_NE(html.find(part), std::string::npos) << part;
}

TEST(ReportJson, StandsWithoutExerciseAndSteps) {
  const Json j = Json::parse(report_json(RunRecorder(), summary(nullptr)));
  EXPECT_EQ(j.at("steps"), 0);
  EXPECT_EQ(j.at("rows").at("max"), 0);
  EXPECT_TRUE(j.at("exercise").at("goals").empty());
  EXPECT_TRUE(j.at("channels").empty());
  EXPECT_EQ(xml_error(report_html(RunRecorder(), summary(nullptr))), "");
}

TEST(ReportJson, IsJsonEvenWhenTheSimulationIsNot) {
  RunRecorder recorder;
  StepReport r;
  r.finite = false;
  r.solve.residual_N = std::numeric_limits<double>::infinity();
  r.time = 0.1;
  recorder.record(r, {{"message", "\xff", "bad \xc3 bytes \x01", 0, 0.1}},
                  {0, std::numeric_limits<double>::quiet_NaN()}, std::numeric_limits<double>::quiet_NaN());
  const Json j = Json::parse(report_json(recorder, summary(nullptr)));
  EXPECT_EQ(j.at("finite"), false);
  EXPECT_EQ(xml_error(report_html(recorder, summary(nullptr))), "");
}

TEST(ReportHtml, IsWellFormedAndSaysWhatItMust) {
  Exercise exercise;
  fill(exercise);
  RunSummary s = summary(&exercise);
  s.mode = "demonstration";
  const std::string html = report_html(hundred_steps(), s);
  EXPECT_EQ(xml_error(html), "");
  for (const char* part :
       {"For training only", "A &lt;title&gt; &amp; more", "Force on the hands", "g: left", "force (N)", "Open it",
        "Too much &lt;force&gt;", "this result is no trainee's", "technical.html", "@media print"})
    EXPECT_NE(html.find(part), std::string::npos) << part;
  // The machine's numbers have a page of their own.
  const std::string technical = technical_html(hundred_steps(), s);
  EXPECT_EQ(xml_error(technical), "");
  for (const char* part :
       {"Rows, contacts and sweeps", "Residual of the solver", "Stages", "wall time (ms)", "fedcba9876543210"}) {
    EXPECT_NE(technical.find(part), std::string::npos) << part;
    EXPECT_EQ(html.find(part), std::string::npos) << part;
  }
  // Self-contained: nothing is fetched.
  for (const char* part : {"<script", "src=", "<link", "url("}) EXPECT_EQ(html.find(part), std::string::npos) << part;
}

TEST(RunSeries, KeepsPeaksWhenItGathers) {
  RunRecorder recorder;
  Gauge gauge(10007);
  for (int k = 0; k < 10007; ++k) {
    StepReport r;
    r.time = 0.001 * k;
    r.rows = k == 5003 ? 999 : 1;
    gauge.show(k, r);
    recorder.record(r, {}, {k == 77 ? 3.0 : 0.0, 0}, 0);
  }
  const RunSeries s = series_of(recorder, 500);
  EXPECT_LE(s.time_s.size(), 500u);
  EXPECT_EQ(*std::max_element(s.rows.begin(), s.rows.end()), 999);
  EXPECT_EQ(*std::max_element(s.hand_force_N[0].begin(), s.hand_force_N[0].end()), 3);
  ASSERT_EQ(s.channels.size(), 3u);
  EXPECT_EQ(s.channels[0].back(), 1);
  EXPECT_NEAR(s.time_s.back(), 10.006, 1e-5);
}

TEST(RunRecorder, ALongRunTakesNoMoreSamplesAndLosesNoPeak) {
  RunRecorder recorder(100);
  const int steps = 1037;
  Gauge gauge(steps);
  for (int k = 1; k <= steps; ++k) {
    StepReport r;
    r.time = 0.01 * k;
    r.rows = k == 511 ? 999 : 1;
    gauge.show(k, r);
    recorder.record(r, {}, {k == 3 ? 3.0 : 0.0, k == 1036 ? 2.0 : 0.0}, 0);
    ASSERT_LE(recorder.samples().size(), 100u);
    ASSERT_EQ(recorder.steps(), k);
  }
  EXPECT_EQ(recorder.steps_per_sample(), 16);
  int held = 0, rows = 0;
  float left = 0, right = 0;
  ASSERT_EQ(recorder.channels().samples(), recorder.samples().size());
  std::size_t i = 0;
  for (const auto& s : recorder.samples()) {
    held += s.steps;
    EXPECT_NEAR(s.time_s, 0.01 * held, 1e-5) << "of the last of its steps";
    EXPECT_EQ(recorder.channels().sample(i++, 0), steps - held);
    rows = std::max(rows, int(s.rows));
    left = std::max(left, s.hand_force_N[0]);
    right = std::max(right, s.hand_force_N[1]);
  }
  EXPECT_EQ(held, steps);
  EXPECT_EQ(rows, 999);
  EXPECT_EQ(left, 3);
  EXPECT_EQ(right, 2);
  EXPECT_EQ(Json::parse(report_json(recorder, summary(nullptr))).at("steps"), steps);
  EXPECT_NE(technical_html(recorder, summary(nullptr)).find("16 steps"), std::string::npos);
}

TEST(RunRecorder, LimitsItsEvents) {
  RunRecorder recorder;
  StepReport r;
  for (int k = 0; k < 5100; ++k) recorder.record(r, {{"message", "a", "b", 0, 0}}, {0, 0}, 0);
  EXPECT_EQ(recorder.events().size(), 5000u);
  EXPECT_EQ(recorder.events_left_out(), 100);
  recorder.clear();
  EXPECT_TRUE(recorder.events().empty());
  EXPECT_TRUE(recorder.samples().empty());
}

TEST(Percentile, IsTheNearestRank) {
  EXPECT_EQ(percentile({}, 0.5), 0);
  EXPECT_EQ(percentile({7}, 0.95), 7);
  EXPECT_EQ(percentile({3, 1, 2}, 0.5), 2);
  EXPECT_EQ(percentile({4, 3, 1, 2}, 0.5), 2);
  EXPECT_EQ(percentile({4, 3, 1, 2}, 1), 4);
  EXPECT_EQ(percentile({4, 3, 1, 2}, 0), 1);
}

TEST(Svg, TicksAreRoundAndCoverTheRange) {
  EXPECT_EQ(nice_ticks(0, 10, 5), (std::vector<double>{0, 2, 4, 6, 8, 10}));
  std::mt19937 random(1);
  for (int i = 0; i < 1000; ++i) {
    const double low = -1 + double(random() % 1000) / 500, high = low + std::pow(10.0, int(random() % 12) - 6);
    const auto ticks = nice_ticks(low, high, 5);
    EXPECT_LE(ticks.front(), low + 1e-9 * std::abs(high - low));
    EXPECT_GE(ticks.back(), high - 1e-9 * std::abs(high - low));
    EXPECT_LE(ticks.size(), 9u);
  }
}

TEST(Svg, IsWellFormedForEveryCurve) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  for (const auto& y :
       {std::vector<double>{}, {0, 0, 0}, {nan, nan, nan}, {1, nan, 3}, {-1, 0, 1e30}, {1e-12, 1e-12, 1e-12}})
    for (bool log : {false, true}) {
      const std::string text =
          svg({"t & t", "x", "y <N>", {0, 1, 2}, {{"c", "#111", y, "2 2"}}, {{1, "m & m", "#222"}}, log});
      EXPECT_EQ(xml_error(text), "");
      EXPECT_EQ(text.find("nan"), std::string::npos);
      EXPECT_EQ(text.find("inf"), std::string::npos);
    }
}

TEST(WriteReport, WritesBothFilesOrSaysWhyNot) {
  const auto dir = std::filesystem::temp_directory_path() / ("insula_report_" + std::to_string(std::random_device()()));
  write_report(dir / "deep", hundred_steps(), summary(nullptr));
  std::ifstream in(dir / "deep" / "report.json");
  EXPECT_EQ(Json::parse(in).at("steps"), 100);
  EXPECT_TRUE(std::filesystem::exists(dir / "deep" / "report.html"));
  std::ofstream(dir / "file") << "x";
  EXPECT_THROW(write_report(dir / "file", RunRecorder(), summary(nullptr)), InputError);
  std::filesystem::remove_all(dir);
}

}  // namespace
}  // namespace insula
