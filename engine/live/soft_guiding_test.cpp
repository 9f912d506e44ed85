// SPDX-License-Identifier: GPL-3.0-or-later
// A cue is also a soft force only where a trainee who practises has chosen it: in the rule, and in a running engine.
#include "engine/live/soft_guiding.h"

#include "engine/live/cause_lines.h"
#include "engine/live/engine_for_test.h"
#include "engine/live/hud.h"

namespace insula {
namespace {

/// A value that is too large from the first step on.
class TooLarge final : public Constraint {
 public:
  Channel<Force> pull{this, {.name = "pull", .doc = "for tests", .display = "mN"}};
  void build(const StepContext&, ConstraintBuilder&) override {}
  void publish() override { pull.set(1); }
};

void add_too_large(Registry& r) { r.add<TooLarge>("too_large", Kind::constraint, "for tests"); }
Registry with_too_large() {
  Registry r;
  register_builtin(r);
  add_too_large(r);
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

class RunningGuide : public test::RunningEngine {
 protected:
  RunningGuide() {
    add_too_large(registry_);
    page_.subscribe(channel::soft_guide, [this](Bytes b) {
      const auto m = decode<insula_lcm::soft_guide_t>(b);
      ASSERT_TRUE(m) << "the engine sends what the haptic server takes";
      EXPECT_EQ(m->hand, 1);
      ++guides_;
    });
    start(pulled_scene, SessionMode::practice);
  }
  bool chosen() const { return hud_.at("tutor").at("soft_guide"); }
  std::string guided() const { return hud_.at("tutor").at("guided"); }

  int guides_ = 0;
};

TEST_F(RunningGuide, IsSentWhenChosenAndRefusedInATest) {
  ASSERT_TRUE(eventually([&] { return time_s_ > 0.3; }));
  EXPECT_EQ(guides_, 0) << "off by default";
  ask("soft_guide", "perhaps");
  EXPECT_TRUE(said("refused", "soft_guide"));
  EXPECT_FALSE(chosen());
  ask("soft_guide", "on");
  EXPECT_TRUE(said("soft_guide", "on"));
  ask("begin", "practice");
  ASSERT_TRUE(eventually([&] { return guides_ > 5; }));
  EXPECT_TRUE(eventually([&] { return chosen() && guided() == "right"; })) << "the page is told";
  events_.clear();
  ask("begin", "test");
  ASSERT_TRUE(eventually([&] { return mode() == "test" && time_s_ > 0.1; }));
  guides_ = 0;
  ask("soft_guide", "on");
  EXPECT_TRUE(said("refused", "soft_guide"));
  ASSERT_TRUE(eventually([&] { return time_s_ > 1; }));
  EXPECT_EQ(guides_, 0);
  EXPECT_EQ(guided(), "");
}

}  // namespace
}  // namespace insula
