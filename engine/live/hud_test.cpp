// SPDX-License-Identifier: GPL-3.0-or-later
// The state beside the picture: keys, and a frame that stays small enough for one message.
#include "engine/live/hud.h"

#include <gtest/gtest.h>

#include <cmath>
#include <nlohmann/json.hpp>

#include "core/bus/codec.h"
#include "core/registry/registry.h"
#include "engine/live/frame.h"
#include "engine/live/shown_contacts.h"

namespace insula {
namespace {

using Json = nlohmann::json;

/// Publishes a channel of every display and a drawable of any number of lines.
class Patient final : public Constraint {
 public:
  Channel<Pressure> pressure{this, {.name = "pressure", .doc = "for tests", .display = "mmHg"}};
  Channel<Vec<Force>> pull{this, {.name = "pull", .doc = "for tests"}};
  Channel<Scalar> silent{this, {.name = "silent", .doc = "never known"}};
  ChannelGroup<FlowRate> flow{this, {.name = "flow", .doc = "for tests"}};
  Polylines lines{this, {.name = "lines", .doc = "for tests", .material = "steel"}};
  Plane level{this, {.name = "level", .doc = "for tests", .material = "steel"}};
  void connect(PrepareContext&, Simulation&) override { flow.declare({"a", "b"}); }
  void build(const StepContext&, ConstraintBuilder&) override {}
  void publish() override {
    pressure.set(13332.2387415);
    pull.set(Vec3(1, 2, 3));
    flow.set(1, 2e-6);
    lines.resize(std::size_t(count));
    for (std::size_t i = 0; i < std::size_t(count); ++i) {
      lines.set(i, 0, Vec3(0.1, 0.2, 0.3), 1);
      lines.set(i, 1, Vec3(0.4, 0.5, 0.6), 0.5);
    }
    level.set(Vec3(0, 0, 0.01), Vec3::UnitZ(), 0.02, 0.7);
  }
  int count = 2;
};
class Clocks final : public ExerciseRule {
 public:
  void declare(PrepareContext&, const Simulation&, ExerciseLog& log) override {
    goal = log.add_goal("g", "Close the neck");
    log.add_goal("other", "Something else");
    clock = log.add_timer("clip", "Temporary clip", 180);
    fault = log.add_fault("f", "Too fast");
    neck = log.add_measure("neck", "Neck remnant", "%", {std::nullopt, 10.0});
    log.add_measure("unknown", "Unknown", "mm");
  }
  void observe(const StepReport& r, ExerciseLog& log) override {
    log.timer(clock, 2 * r.time, true);
    log.measure(neck, 12.5, -1);
    log.fault(fault, r.time, 0);
  }
  int goal = 0, clock = 0, neck = 0, fault = 0;
};

Registry registry() {
  Registry r;
  register_builtin(r);
  r.add<Patient>("patient", Kind::constraint, "for tests");
  r.add<Clocks>("clocks", Kind::exercise_rule, "for tests");
  return r;
}

TEST(Hud, TellsOfTheExercise) {
  const Registry r = registry();
  auto loaded = load_simulation_text(
      R"(<scene time_step="10 ms"><patient/><exercise id="e" title="E"><clocks/></exercise></scene>)", "/s.xml", r, 1);
  ASSERT_TRUE(loaded.simulation) << loaded.diagnostics.format();
  loaded.simulation->step();
  const Json j = Json::parse(hud_json(*loaded.simulation));
  EXPECT_EQ(j.at("timers").at(0).at("elapsed_s"), 0.02);
  EXPECT_EQ(j.at("timers").at(0).at("limit_s"), 180);
  EXPECT_EQ(j.at("timers").at(0).at("running"), true);
  EXPECT_EQ(j.at("measures").at(0).at("value"), 12.5);
  EXPECT_EQ(j.at("measures").at(0).at("good"), -1);
  EXPECT_TRUE(j.at("measures").at(1).at("value").is_null());
  EXPECT_EQ(j.at("state"), "running");
}

TEST(Hud, TellsOfTheSessionAndOfEachFault) {
  const Registry r = registry();
  auto loaded = load_simulation_text(
      R"(<scene time_step="10 ms"><patient/><exercise id="e" title="E"><clocks advice="Go slower"/></exercise></scene>)",
      "/s.xml", r, 1);
  ASSERT_TRUE(loaded.simulation) << loaded.diagnostics.format();
  for (int k = 0; k < 40; ++k) loaded.simulation->step();
  const Json j =
      Json::parse(hud_json(*loaded.simulation, {SessionMode::demonstration, "/r/report.html", "/s/a.insula"}));
  EXPECT_EQ(j.at("mode"), "demonstration");
  EXPECT_EQ(j.at("report"), "/r/report.html");
  EXPECT_EQ(j.at("recording"), "/s/a.insula");
  EXPECT_EQ(j.at("unrecorded"), "");
  const Json& fault = j.at("faults").at(0);
  EXPECT_EQ(fault.at("advice"), "Go slower");
  EXPECT_EQ(fault.at("count"), 40);
  ASSERT_EQ(fault.at("times_s").size(), FaultState::most_times);
  EXPECT_EQ(fault.at("times_s").at(9), 0.1);
  EXPECT_EQ(j.at("measures").at(0).at("limit"), "at most 10 %");
  loaded.simulation->reset();
  EXPECT_TRUE(Json::parse(hud_json(*loaded.simulation)).at("faults").at(0).at("times_s").empty());
}

TEST(Hud, HasTheSameKeysWithoutAnExercise) {
  const Registry r = registry();
  auto loaded = load_simulation_text("<scene/>", "/s.xml", r, 1);
  ASSERT_TRUE(loaded.simulation);
  loaded.simulation->step();
  const Json j = Json::parse(hud_json(*loaded.simulation));
  for (const char* key : {"goals", "faults", "timers", "measures", "hands"}) EXPECT_TRUE(j.at(key).is_array()) << key;
  for (const char* key : {"message", "state", "elapsed_s", "mode", "report", "recording", "unrecorded"})
    EXPECT_TRUE(j.contains(key)) << key;
  EXPECT_TRUE(j.at("tutor").at("cue").is_null());
  EXPECT_TRUE(j.at("tutor").at("causes").is_array());
  EXPECT_EQ(j.size(), 13u);
}

TEST(Hud, SendsTheLastCueOfTheTutorButNotInATest) {
  const Registry r = registry();
  auto loaded = load_simulation_text(
      R"(<scene time_step="10 ms"><patient id="p"/><exercise id="e" title="E"><clocks/><tutor/>
         <hint_channel id="lower" text="Lower it" channel="p.pressure" limit="80 mmHg" at="left"/></exercise></scene>)",
      "/s.xml", r, 1);
  ASSERT_TRUE(loaded.simulation) << loaded.diagnostics.format();
  for (int k = 0; k < 3; ++k) loaded.simulation->step();
  const auto tutor = [&](SessionMode mode) {
    return Json::parse(hud_json(*loaded.simulation, {.mode = mode})).at("tutor");
  };
  const Json practice = tutor(SessionMode::practice);
  EXPECT_EQ(practice.at("cue").at("text"), "Lower it");
  EXPECT_EQ(practice.at("cue").at("hand"), "left");
  EXPECT_EQ(practice.at("cue").at("watched"), "p.pressure");
  EXPECT_EQ(practice.at("cue").at("value"), "100.00 mmHg");
  EXPECT_EQ(practice.at("cue").at("limit"), "80.00 mmHg");
  EXPECT_TRUE(practice.at("cues").empty()) << "the whole list comes after the end";
  const Json test = tutor(SessionMode::test);
  EXPECT_TRUE(test.at("cue").is_null());
  ASSERT_EQ(test.at("causes").size(), 1u) << "the instructor sees them";
  EXPECT_EQ(test.at("causes").at(0).at("share"), 1.25);
  Exercise& exercise = *loaded.simulation->exercise();
  exercise.log().fail("over", 1);
  EXPECT_EQ(tutor(SessionMode::test).at("cues").size(), 1u) << "why it came can be read afterwards";
}

TEST(Frame, CarriesChannelsAndDrawables) {
  const Registry r = registry();
  auto loaded = load_simulation_text(R"(<scene><patient id="p"/></scene>)", "/s.xml", r, 1);
  ASSERT_TRUE(loaded.simulation) << loaded.diagnostics.format();
  loaded.simulation->step();
  insula_lcm::render_frame_t f{};
  fill_frame(*loaded.simulation, f);
  ASSERT_EQ(f.channels, 7);
  EXPECT_EQ(f.channel[0], 13332.2387415f);
  for (int k = 0; k < 3; ++k) EXPECT_EQ(f.channel[std::size_t(1 + k)], float(1 + k));
  EXPECT_TRUE(std::isnan(f.channel[4]));
  EXPECT_TRUE(std::isnan(f.channel[5])) << "flow of a was never said";
  EXPECT_EQ(f.channel[6], 2e-6f);
  EXPECT_EQ(loaded.simulation->channels().entries().back().id, "p.b.flow");
  ASSERT_EQ(f.drawables, 2);
  EXPECT_EQ(f.drawable[0].data, (std::vector<float>{0.1f, 0.2f, 0.3f, 1, 0.4f, 0.5f, 0.6f, 0.5f, 0.1f, 0.2f, 0.3f, 1,
                                                    0.4f, 0.5f, 0.6f, 0.5f}));
  EXPECT_EQ(f.drawable[1].data, (std::vector<float>{0, 0, 0.01f, 0, 0, 1, 0.02f, 0.7f}));
  loaded.simulation->reset();
  EXPECT_EQ(loaded.simulation->channel("p.b.flow"), 2e-6) << "published again at the start";
}

TEST(ExerciseLog, AGoalMayBeLostAgainWhileTheExerciseRuns) {
  ExerciseLog log;
  const int a = log.add_goal("a", "A"), b = log.add_goal("b", "B");
  log.goal_lost(a, 0.5);  // was never reached: nothing
  EXPECT_TRUE(log.events.events().empty());
  log.goal(a, 1);
  log.goal_lost(a, 2);
  EXPECT_FALSE(log.goals()[0].done);
  EXPECT_EQ(log.goals()[0].time, -1);
  ASSERT_EQ(log.events.events().size(), 2u);
  EXPECT_EQ(log.events.events()[1].kind, "goal_lost");
  log.goal(b, 3);
  EXPECT_EQ(log.state(), ExerciseState::running);
  log.goal(a, 4);
  EXPECT_EQ(log.state(), ExerciseState::done);
  log.goal_lost(b, 5);
  EXPECT_TRUE(log.goals()[1].done) << "an end stays";
  log.reset();
  EXPECT_FALSE(log.goals()[1].done);
}

// A vessel of 2,000 nodes, two lobes of 900 together, 70 lines, 200 channels, 50 tools, all contacts, all words.
TEST(Frame, StaysUnderWhatOneMessageCarries) {
  const Registry r = registry();
  auto loaded = load_simulation_text(
      R"(<scene><patient id="p"/><exercise id="e" title="E"><clocks/></exercise></scene>)", "/s.xml", r, 1);
  ASSERT_TRUE(loaded.simulation);
  auto* patient = loaded.simulation->scene().find_as<Patient>("p");
  patient->count = 70;
  loaded.simulation->step();
  insula_lcm::render_frame_t f{};
  fill_frame(*loaded.simulation, f);
  f.bodies = 3;
  f.body.resize(3);
  f.body_force_N.assign(3, 0.1);
  const int nodes[] = {2000, 450, 450};
  for (int b = 0; b < 3; ++b) {
    f.body[std::size_t(b)].index = b;
    f.body[std::size_t(b)].nodes = nodes[b];
    f.body[std::size_t(b)].x_m.assign(std::size_t(nodes[b]), std::vector<float>(3, 0.01f));
  }
  f.channels = 200;
  f.channel.assign(200, 1.f);
  insula_lcm::render_tool_t tool{};
  tool.q[0] = 1;
  f.tools = 50;
  f.tool.assign(50, tool);
  f.contacts = std::int32_t(most_shown_contacts);
  f.contact_x_m.assign(most_shown_contacts, std::vector<float>(3, 0.f));
  f.contact_N.assign(most_shown_contacts, 0.f);
  f.contact_side.assign(most_shown_contacts, std::vector<std::int16_t>(2, 0));
  std::vector<std::uint8_t> bytes;
  ASSERT_TRUE(encode(f, bytes));
  EXPECT_LT(bytes.size(), 120'000u);
  EXPECT_GT(bytes.size(), 12u * 2900);
  std::string why;
  insula_lcm::render_frame_t back{};
  EXPECT_TRUE(decode(bytes, back, why)) << why;
}

}  // namespace
}  // namespace insula
