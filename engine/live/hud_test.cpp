// SPDX-License-Identifier: GPL-3.0-or-later
// The state beside the picture: keys, units, and a frame that stays small enough for one message.
#include "engine/live/hud.h"

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "core/bus/codec.h"
#include "core/registry/registry.h"
#include "engine/live/frame.h"

namespace insula {
namespace {

using Json = nlohmann::json;

/// Reports a vessel, a bleeding and a heart; the clip is no body of the scene.
class Patient final : public Constraint {
 public:
  void connect(PrepareContext&, Simulation&) override {}
  void build(const StepContext&, ConstraintBuilder&) override {}
  void finish(const StepContext&, const ConstraintSolution&) override {}
  void reset() override {}
  void append_state(std::vector<double>&) const override {}
  void report(StepReport& r) const override {
    for (int i = 0; i < vessels; ++i) r.vessels.push_back({"superior", 13332.2387415, 1e-6, 2e-6, 0.25, 0.125});
    for (int i = 0; i < clips; ++i) {
      ClipState c;
      c.on_tray = false;
      c.temporary = true;
      c.opening = 0.12345678;
      c.force = 1.5;
      c.applications = 2;
      r.clips.push_back(c);
    }
    BleedingState b;
    b.open = true;
    b.rate = 1e-6;
    b.lost = 3.25e-6;
    b.height = 0.004;
    b.origin = Vec3(0.01, 0.02, 0.03);
    b.radius = 0.015;
    b.since = 0;
    r.bleeding.push_back(b);
    r.heart_phase = 0.5;
  }
  int vessels = 1, clips = 1;
};
class Clocks final : public ExerciseRule {
 public:
  void declare(PrepareContext&, const Simulation&, ExerciseLog& log) override {
    goal = log.add_goal("g", "Close the neck");
    log.add_goal("other", "Something else");
    clock = log.add_timer("clip", "Temporary clip", 180);
    neck = log.add_measure("neck", "Neck remnant", "%");
    log.add_measure("unknown", "Unknown", "mm");
  }
  void observe(const StepReport& r, ExerciseLog& log) override {
    log.timer(clock, 2 * r.time, true);
    log.measure(neck, 12.5, -1);
  }
  int goal = 0, clock = 0, neck = 0;
};

Registry registry() {
  Registry r;
  register_builtin(r);
  r.add<Patient>("patient", Kind::constraint, "for tests");
  r.add<Clocks>("clocks", Kind::exercise_rule, "for tests");
  return r;
}

TEST(Hud, SaysItInTheUnitsOfTheClinic) {
  const Registry r = registry();
  auto loaded = load_simulation_text(R"(<scene time_step="10 ms"><patient/><exercise id="e" title="E"><clocks/></exercise></scene>)", "/s.xml", r, 1);
  ASSERT_TRUE(loaded.simulation) << loaded.diagnostics.format();
  loaded.simulation->step();
  const Json j = Json::parse(hud_json(*loaded.simulation));
  const Json& v = j.at("vessels").at(0);
  EXPECT_EQ(v.at("id"), "superior");
  EXPECT_EQ(v.at("pressure_mmHg"), 100);
  EXPECT_EQ(v.at("flow_mL_min"), 60);
  EXPECT_EQ(v.at("flow_percent"), 50);
  EXPECT_EQ(v.at("lumen_percent"), 25);
  EXPECT_EQ(v.at("dye"), 0.125);
  const Json& b = j.at("blood");
  EXPECT_EQ(b.at("open"), true);
  EXPECT_EQ(b.at("rate_mL_min"), 60);
  EXPECT_EQ(b.at("lost_mL"), 3.25);
  EXPECT_EQ(b.at("height_m"), 0.004);
  EXPECT_EQ(b.at("origin"), Json({0.01, 0.02, 0.03}));
  EXPECT_EQ(b.at("up"), Json({0, 0, 1}));
  EXPECT_EQ(b.at("since_s"), 0.01);
  const Json& c = j.at("clips").at(0);
  EXPECT_EQ(c.at("state"), "free");
  EXPECT_TRUE(c.at("holder").is_null());
  EXPECT_EQ(c.at("opening_rad"), 0.1235);
  EXPECT_EQ(c.at("applications"), 2);
  EXPECT_EQ(j.at("heart_phase"), 0.5);
  EXPECT_EQ(j.at("timers").at(0).at("elapsed_s"), 0.02);
  EXPECT_EQ(j.at("timers").at(0).at("limit_s"), 180);
  EXPECT_EQ(j.at("timers").at(0).at("running"), true);
  EXPECT_EQ(j.at("measures").at(0).at("value"), 12.5);
  EXPECT_EQ(j.at("measures").at(0).at("good"), -1);
  EXPECT_TRUE(j.at("measures").at(1).at("value").is_null());
  EXPECT_EQ(j.at("state"), "running");
}

TEST(Hud, HasTheSameKeysWithoutAnExercise) {
  const Registry r = registry();
  auto loaded = load_simulation_text("<scene/>", "/s.xml", r, 1);
  ASSERT_TRUE(loaded.simulation);
  loaded.simulation->step();
  const Json j = Json::parse(hud_json(*loaded.simulation));
  for (const char* key : {"goals", "faults", "timers", "measures", "vessels", "clips", "hands"}) EXPECT_TRUE(j.at(key).is_array()) << key;
  for (const char* key : {"message", "state", "elapsed_s", "strands_left", "strands_total", "heart_phase"}) EXPECT_TRUE(j.contains(key)) << key;
  EXPECT_FALSE(j.contains("blood"));
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

// A vessel of 2,000 nodes, two lobes of 900 together, 70 strands, 50 tools and clips, all contacts, all words.
TEST(Frame, StaysUnderWhatOneMessageCarries) {
  const Registry r = registry();
  auto loaded = load_simulation_text(R"(<scene><patient id="p"/><exercise id="e" title="E"><clocks/></exercise></scene>)", "/s.xml", r, 1);
  ASSERT_TRUE(loaded.simulation);
  auto* patient = loaded.simulation->scene().find_as<Patient>("p");
  patient->vessels = 10;
  patient->clips = 50;
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
  f.strands = 70;
  f.strand_points = 140;
  f.strand_x_m.assign(140, std::vector<float>(3, 0.f));
  f.strand_integrity.assign(70, 1.f);
  f.strand_tension_N.assign(70, 0.f);
  insula_lcm::render_tool_t tool{};
  tool.q[0] = 1;
  f.tools = 50;
  f.tool.assign(50, tool);
  f.contacts = 120;
  f.contact_x_m.assign(120, std::vector<float>(3, 0.f));
  f.contact_N.assign(120, 0.f);
  std::vector<std::uint8_t> bytes;
  ASSERT_TRUE(encode(f, bytes));
  EXPECT_LT(bytes.size(), 120'000u);
  EXPECT_GT(bytes.size(), 12u * 2900);
  std::string why;
  insula_lcm::render_frame_t back;
  EXPECT_TRUE(decode(bytes, back, why)) << why;
}

}  // namespace
}  // namespace insula
