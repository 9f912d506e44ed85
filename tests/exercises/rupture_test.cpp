// SPDX-License-Identifier: GPL-3.0-or-later
// Exercise 4 with both scripted motions.
#include "tests/exercises/play_motion.h"
#include "tests/exercises/told_hints.h"

namespace insula {
namespace {

const std::filesystem::path rupture_scene = std::filesystem::path(INSULA_SOURCE_DIR) / "scenes/training/4_rupture.xml";

/// Flow of the parent artery and rate of the bleeding, before the temporary clip and from two seconds after its release
/// until the applier holds it again. Flow is the mean of a heartbeat, so it needs that time. The rate is taken until
/// the next clip comes: it squeezes the dome.
struct ProximalControl {
  double flow = 0, rate = 0, rate_before = 0;  ///< largest ones; flow over that at rest, m3/s
  double lumen = 0;                            ///< of the parent, largest over that at rest
  double since_release = 0;                    ///< s
  void see(const Simulation& s) {
    constexpr double free_in_the_field = 2;
    const bool on = s.channel("temporary_curved.place") == free_in_the_field;
    since_release = on ? since_release + s.h() : 0;
    const double now = s.channel("bleeding.rate");
    if (!on && flow == 0) rate_before = std::max(rate_before, now);
    if (since_release < 2) return;
    flow = std::max(flow, s.channel("flow.parent.flow_share"));
    lumen = std::max(lumen, s.channel("flow.parent.lumen"));
    if (s.channel("angled.place") == 0) rate = std::max(rate, now);
  }
};

TEST(Rupture, MasteredWithTemporaryAndFinalClip) {
  ProximalControl proximal;
  test::ToldHints told;
  test::Played o = test::play_motion(rupture_scene, "steady", -1, [&](const Simulation& s) {
    proximal.see(s);
    told.listener()(s);
  });
  ASSERT_TRUE(o.ran);
  EXPECT_TRUE(o.finite);
  EXPECT_EQ(o.state, ExerciseState::done);
  EXPECT_EQ(o.events["rupture"], 1);
  EXPECT_EQ(o.events["clip_released"], 2);
  EXPECT_EQ(o.events["clip_taken"], 1);
  EXPECT_GT(o.goals["stop"], 0);
  EXPECT_GT(o.goals["together"], 0);
  EXPECT_GT(o.goals["removed"], o.goals["stop"] - 1e-9);
  EXPECT_GT(o.longest["occlusion"], 5);
  EXPECT_LT(o.longest["occlusion"], 180);
  EXPECT_LT(o.longest["since_rupture"], 300);
  EXPECT_LT(proximal.flow, 0.02) << "the temporary clip shuts the parent artery";
  EXPECT_LT(proximal.lumen, 0.02);
  EXPECT_GT(60e6 * proximal.rate_before, 40) << "ml/min";
  EXPECT_LT(proximal.rate, 0.1 * proximal.rate_before) << "what still bleeds drains from the branches";
  test::expect_well_clipped(o);
  test::expect_gentle(o);
  told.expect_few();
  told.expect_told();
  EXPECT_FALSE(told.first_held.contains("stenosis_hint")) << "the flow is only not known yet after the temporary clip";
  EXPECT_GT(o.measures["tip_past_neck"], 0.1);
  EXPECT_GT(o.min_pressure, -40) << "Pa: the torn sac that a clip cuts off comes to the pressure outside";
}

TEST(Rupture, OneHandAloneDoesNotMasterIt) {
  test::Played o = test::play_motion(rupture_scene, "steady", 1);
  ASSERT_TRUE(o.ran);
  EXPECT_GT(o.goals["stop"], 0) << "the clips stop the bleeding all the same";
  EXPECT_LT(o.goals["together"], 0) << "nobody sucked while a clip closed";
  EXPECT_EQ(o.state, ExerciseState::running);
}

TEST(Rupture, TimeRunsOutWhenNobodyClips) {
  test::ToldHints told;
  test::Played o = test::play_motion(rupture_scene, "late", -1, told.listener());
  ASSERT_TRUE(o.ran);
  told.expect_told();
  EXPECT_NEAR(told.first_cue["time_hint"], 241, 0.2) << "a minute before it is too late";
  EXPECT_TRUE(o.finite);
  EXPECT_EQ(o.state, ExerciseState::failed);
  EXPECT_NEAR(o.end, 301, 0.1);
  EXPECT_LT(o.goals["stop"], 0);
  EXPECT_NEAR(o.longest["since_rupture"], 300, 1);  // the clock goes on until the motion ends
}

}  // namespace
}  // namespace insula
