// SPDX-License-Identifier: GPL-3.0-or-later
// A cue is also a soft force only where a trainee who practises has chosen it: in the rule, and in a running engine.
#include "engine/live/soft_guiding.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include <fstream>
#include <nlohmann/json.hpp>
#include <thread>

#include "core/bus/channels.h"
#include "core/bus/codec.h"
#include "core/bus/mem_bus.h"
#include "core/registry/registry.h"
#include "engine/live/cause_lines.h"
#include "engine/live/hud.h"
#include "engine/live/live_engine.h"

namespace insula {
namespace {

namespace fs = std::filesystem;

/// A value that is too large from the first step on.
class TooLarge final : public Constraint {
 public:
  Channel<Force> pull{this, {.name = "pull", .doc = "for tests", .display = "mN"}};
  void build(const StepContext&, ConstraintBuilder&) override {}
  void publish() override { pull.set(1); }
};

Registry with_too_large() {
  Registry r;
  register_builtin(r);
  r.add<TooLarge>("too_large", Kind::constraint, "for tests");
  return r;
}

const char* const pulled_scene = R"(<scene time_step="10 ms"><too_large id="g"/><exercise id="e" title="E">
  <goal_channel text="Never" channel="g.pull" limit="2 N"/><tutor/>
  <hint_channel id="less" text="Less" channel="g.pull" limit="0.5 N" at="right" away="0 0 -2"/></exercise></scene>)";

/// Steps of 200 in which a guide lasts.
int guided_steps(bool chosen, SessionMode mode) {
  const Registry r = with_too_large();
  auto loaded = load_simulation_text(pulled_scene, "/s.xml", r, 1);
  EXPECT_TRUE(loaded.simulation) << loaded.diagnostics.format();
  if (!loaded.simulation) return -1;
  SoftGuiding guiding;
  guiding.choose(chosen);
  int out = 0;
  for (int k = 0; k < 200; ++k) {
    loaded.simulation->step();
    if (const auto& now = guiding.step(*loaded.simulation, mode)) {
      ++out;
      EXPECT_EQ(now->hand, 1);
      EXPECT_EQ(now->number, 1);
      EXPECT_NEAR((now->direction - Vec3(0, 0, -1)).norm(), 0, 1e-12) << "a unit vector";
    }
  }
  return out;
}

TEST(SoftGuiding, FollowsACueOnlyIfChosenAndOnlyInPractice) {
  EXPECT_NEAR(guided_steps(true, SessionMode::practice), 100 * SoftGuiding::duration_s, 1);
  EXPECT_EQ(guided_steps(false, SessionMode::practice), 0) << "off by default";
  for (const SessionMode mode : {SessionMode::test, SessionMode::demonstration, SessionMode::waiting})
    EXPECT_EQ(guided_steps(true, mode), 0) << name_of(mode);
}

TEST(SoftGuiding, EndsWithAModeAResetAndTheChoice) {
  const Registry r = with_too_large();
  auto loaded = load_simulation_text(pulled_scene, "/s.xml", r, 1);
  ASSERT_TRUE(loaded.simulation);
  Simulation& s = *loaded.simulation;
  SoftGuiding guiding;
  guiding.choose(true);
  const auto steps = [&](SessionMode mode) {
    for (int k = 0; k < 10; ++k) {
      s.step();
      guiding.step(s, mode);
    }
    return guiding.now().has_value();
  };
  EXPECT_TRUE(steps(SessionMode::practice));
  EXPECT_FALSE(steps(SessionMode::test));
  EXPECT_FALSE(steps(SessionMode::practice)) << "what ended does not begin again";
  s.reset();
  EXPECT_TRUE(steps(SessionMode::practice));
  EXPECT_EQ(guiding.now()->number, 2);
  guiding.choose(false);
  EXPECT_FALSE(steps(SessionMode::practice));
}

TEST(SoftGuiding, CausesOfHintsAreMadeTenTimesASecond) {
  const Registry r = with_too_large();
  auto loaded = load_simulation_text(pulled_scene, "/s.xml", r, 1);
  ASSERT_TRUE(loaded.simulation);
  CauseLines kept;
  int made = 0;
  struct Counts final : public GivesCues {
    int* made = nullptr;
    std::vector<Cue> none;
    const std::vector<Cue>& cues() const override { return none; }
    std::vector<HintCause> causes() const override {
      ++*made;
      HintCause cause;
      cause.id = std::to_string(*made);
      return {cause};
    }
  } tutor;
  tutor.made = &made;
  for (int k = 0; k < 120; ++k) EXPECT_EQ(kept.of(tutor, k / 60.0).size(), 1u) << "each frame has them";
  EXPECT_NEAR(made, 20, 1) << "2 s";
  kept.of(tutor, 0);
  EXPECT_NEAR(made, 21, 1) << "a reset renews them";
}

/// A running engine, and a page that listens.
class RunningGuide : public ::testing::Test {
 protected:
  RunningGuide() {
    fs::create_directories(folder_);
    std::ofstream(folder_ / "s.xml") << pulled_scene;
    page_.subscribe(channel::soft_guide, [this](Bytes b) {
      const auto m = decode<insula_lcm::soft_guide_t>(b);
      ASSERT_TRUE(m) << "the engine sends what the haptic server takes";
      EXPECT_EQ(m->hand, 1);
      ++guides_;
    });
    page_.subscribe(channel::sim_event, [this](Bytes b) {
      if (const auto m = decode<insula_lcm::sim_event_t>(b)) events_.push_back(m->kind + " " + m->id);
    });
    page_.subscribe(channel::render_frame, [this](Bytes b) {
      const auto m = decode<insula_lcm::render_frame_t>(b);
      ASSERT_TRUE(m);
      const auto hud = nlohmann::json::parse(m->hud_json);
      mode_ = hud.at("mode");
      chosen_ = hud.at("tutor").at("soft_guide");
      guided_ = hud.at("tutor").at("guided");
      time_s_ = m->sim_time_s;
    });
    LiveOptions options;
    options.scene = folder_ / "s.xml";
    options.bundle_root = folder_ / "bundles";
    options.motion = "none";
    options.mode = SessionMode::practice;
    engine_ = std::thread([this, options] { run_live(options, registry_, bus_, stop_); });
  }
  ~RunningGuide() override {
    stop_ = true;
    engine_.join();
    fs::remove_all(folder_);
  }
  void ask(const char* command, const char* argument) {
    insula_lcm::user_command_t m{};
    m.command = command;
    m.argument = argument;
    ASSERT_TRUE(publish(page_, channel::user_command, m, scratch_));
  }
  template <class Condition>
  bool eventually(Condition condition) {
    for (int k = 0; k < 6000 && !condition(); ++k) page_.poll(10);
    return condition();
  }
  bool said(const std::string& event) {
    return eventually([&] { return std::find(events_.begin(), events_.end(), event) != events_.end(); });
  }

  fs::path folder_ = fs::temp_directory_path() / ("insula_guide_" + std::to_string(::getpid()));
  std::shared_ptr<MemHub> hub_ = std::make_shared<MemHub>();
  MemBus bus_{hub_}, page_{hub_};
  Registry registry_ = with_too_large();
  std::atomic<bool> stop_{false};
  std::thread engine_;
  int guides_ = 0;
  bool chosen_ = false;
  std::string mode_, guided_;
  double time_s_ = 0;
  std::vector<std::string> events_;
  std::vector<std::uint8_t> scratch_;
};

TEST_F(RunningGuide, IsSentWhenChosenAndRefusedInATest) {
  ASSERT_TRUE(eventually([&] { return time_s_ > 0.3; }));
  EXPECT_EQ(guides_, 0) << "off by default";
  ask("soft_guide", "perhaps");
  EXPECT_TRUE(said("refused soft_guide"));
  EXPECT_FALSE(chosen_);
  ask("soft_guide", "on");
  EXPECT_TRUE(said("soft_guide on"));
  ask("begin", "practice");
  ASSERT_TRUE(eventually([&] { return guides_ > 5; }));
  EXPECT_TRUE(eventually([&] { return chosen_ && guided_ == "right"; })) << "the page is told";
  events_.clear();
  ask("begin", "test");
  ASSERT_TRUE(eventually([&] { return mode_ == "test" && time_s_ > 0.1; }));
  guides_ = 0;
  ask("soft_guide", "on");
  EXPECT_TRUE(said("refused soft_guide"));
  ASSERT_TRUE(eventually([&] { return time_s_ > 1; }));
  EXPECT_EQ(guides_, 0);
  EXPECT_EQ(guided_, "");
}

}  // namespace
}  // namespace insula
