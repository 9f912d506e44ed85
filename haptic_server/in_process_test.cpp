// SPDX-License-Identifier: GPL-3.0-or-later
// Both arms in simulated time: determinism, following, forces through the gate, counting.
#include "haptic_server/in_process.h"

#include <gtest/gtest.h>

#include <cmath>

#include "haptic_server/devices/make_device.h"
#include "haptic_server/problem_for_test.h"

namespace insula {
namespace {

/// One frictionless contact under the left hand's tool: a wall of tissue at z = surface.
ConstraintProblem wall_problem(const Pose& device, double surface, double compliance) {
  ConstraintProblem p;
  p.resize(1);
  ToolTerms t = testing::held_tool(0, device, 1);
  t.jacobian(0, 2) = 1;
  p.w[0] = t.compliance(2, 2) + compliance;
  p.delta_free[0] = t.free.p.z() - surface;
  Block b;
  b.id = 1;
  b.lower = 0;
  p.blocks.push_back(b);
  p.tools.push_back(t);
  return p;
}

Motion press() {
  Motion m;
  m.add(0, {0, {Pose{Vec3(0, 0, 0.01), Quat::Identity()}, false, false}});
  m.add(0, {0.5, {Pose{Vec3(0, 0, -0.008), Quat::Identity()}, true, false}});
  m.add(0, {2, {Pose{Vec3(0.005, 0, -0.008), Quat::Identity()}, true, true}});
  return m;
}

/// A little engine: sixty problems a second from where the device is.
void run(InProcessHaptics& haptics, int steps) {
  for (int step = 0; step < steps; ++step) {
    haptics.set_problem(wall_problem(haptics.hand(0).device, 0, 1.0 / 200));
    const double start = haptics.time();
    for (int k = 1; k <= 17; ++k) haptics.tick(start + k / 60.0 / 17);
  }
}

TEST(InProcess, PressesWithTheForceOfTheSpringsInSeries) {
  std::array<ArmParameters, 2> arms{simulated_arm(0), simulated_arm(1)};
  for (ArmParameters& a : arms) a.tremor_m = a.tremor_rad = 0;
  InProcessHaptics haptics(press(), {}, {}, arms);
  run(haptics, 240);
  // Hand 400 N/m, coupling 300 N/m and tissue 200 N/m between the goal at -8 mm and the surface at 0.
  const double k = 1 / (1 / 400.0 + 1 / 300.0 + 1 / 200.0);
  EXPECT_NEAR(haptics.hand(0).force.z(), k * 0.008, 300 * 55e-6);  // the force's resolution
  EXPECT_GE(haptics.hand(0).max_force_N, haptics.hand(0).force.norm());
  EXPECT_LE(haptics.hand(0).max_force_N, 3.3 + 1e-12);
  EXPECT_TRUE(haptics.hand(0).button1);
  EXPECT_TRUE(haptics.hand(0).button2);
  EXPECT_FALSE(haptics.hand(1).present);
}

TEST(InProcess, AMovingHandGetsAFreshForceAtEachTick) {
  InProcessHaptics haptics(press());
  run(haptics, 120);
  EXPECT_GT(haptics.fresh_forces_per_s(), 950);
  EXPECT_LE(haptics.fresh_forces_per_s(), 17 * 60 + 1);
}

TEST(InProcess, SameProblemsAndMotionGiveTheSameBits) {
  InProcessHaptics a(press()), b(press());
  run(a, 60);
  run(b, 60);
  EXPECT_EQ(a.hand(0).force, b.hand(0).force);
  EXPECT_EQ(a.hand(0).device.p, b.hand(0).device.p);
  EXPECT_EQ(a.hand(0).fresh_forces, b.hand(0).fresh_forces);
  // ... and after a reset.
  a.reset();
  EXPECT_EQ(a.hand(0).force.norm(), 0);
  run(a, 60);
  EXPECT_EQ(a.hand(0).force, b.hand(0).force);
  EXPECT_EQ(a.hand(0).device.q.coeffs(), b.hand(0).device.q.coeffs());
}

TEST(InProcess, ForcesEndWhenProblemsEnd) {
  InProcessHaptics haptics(press());
  run(haptics, 100);
  EXPECT_GT(haptics.hand(0).force.norm(), 0.3);
  haptics.advance(101);
  EXPECT_EQ(haptics.hand(0).force, Vec3(0, 0, 0));
}

TEST(InProcess, SlewHoldsFromTickToTick) {
  InProcessHaptics haptics(press());
  Vec3 last = Vec3::Zero();
  for (int step = 0; step < 120; ++step) {
    if (step % 40 < 30) haptics.set_problem(wall_problem(haptics.hand(0).device, 0.003, 1.0 / 2000));
    for (int k = 0; k < 17; ++k) {
      haptics.advance(1, 1e-3);
      ASSERT_LE((haptics.hand(0).force - last).norm(), 66e-3 * (1 + 1e-9));
      last = haptics.hand(0).force;
    }
  }
}

TEST(InProcess, AHandWithoutAScriptStaysHome) {
  std::array<HandHome, 2> home;
  home[1] = {true, Pose{Vec3(0.02, 0, 0.05), Quat::Identity()}};
  InProcessHaptics haptics(press(), home);
  run(haptics, 30);
  EXPECT_TRUE(haptics.hand(1).present);
  EXPECT_NEAR((haptics.hand(1).device.p - home[1].pose.p).norm(), 0, 150e-6);
  EXPECT_EQ(haptics.hand(1).force, Vec3(0, 0, 0));  // no tool of this hand in the problem
}

}  // namespace
}  // namespace insula
