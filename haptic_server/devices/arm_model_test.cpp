// SPDX-License-Identifier: GPL-3.0-or-later
// The simulated arm: closed forms, energy, stops, resolution, stability, determinism.
#include "haptic_server/devices/arm_model.h"

#include <gtest/gtest.h>

#include <cmath>

#include "core/base/input_error.h"
#include "core/testing/held.h"
#include "haptic_server/devices/make_device.h"
#include "haptic_server/devices/simulated.h"
#include "haptic_server/problem_for_test.h"
#include "tests/figures/figure.h"

namespace insula {
namespace {

constexpr double dt = 1e-3;
const Vec3 none = Vec3::Zero();
const Vec3 wide = Vec3::Constant(10);

ArmParameters calm() {
  ArmParameters p = simulated_arm(0);
  p.tremor_m = p.tremor_rad = 0;
  return p;
}

TEST(ArmModel, RestsForceOverStiffnessAway) {
  ArmModel arm(calm());
  const Pose home{Vec3(0.01, 0.02, 0.03), from_rotation_vector(Vec3(0.3, 0, 0))};
  arm.place(home, home.p, wide);
  const Vec3 force(0.8, -0.4, 1.2), torque(0.01, 0.02, -0.03);
  arm.set_load(force, torque);
  for (int k = 0; k < 3000; ++k) arm.step(dt);
  const ArmParameters& p = arm.parameters();
  EXPECT_TRUE(test::held("an arm at rest, m", (arm.pose().p - home.p - force / p.hand_stiffness_N_m).norm(), 1, 1e-12));
  EXPECT_TRUE(test::held("an arm at rest, rad",
                         (displacement(home, arm.pose()).tail<3>() - torque / p.hand_stiffness_Nm_rad).norm(), 1,
                         1e-9));
  EXPECT_NEAR(arm.v().norm(), 0, 1e-12);
}

TEST(ArmModel, StepIsImplicitEulerExactly) {
  ArmParameters p = calm();
  ArmModel arm(p);
  arm.place(Pose(), none, wide);
  HandGoal goal;
  goal.pose.p = Vec3(0.004, 0, 0);
  goal.v = Vec3(0.1, 0, 0);
  arm.set_goal(goal);
  arm.set_load(Vec3(0.5, 0, 0), none);
  double x = 0, v = 0, law_x = 0, law_v = 0;
  const double m = p.arm_mass_kg + p.hand_mass_kg;
  test::Figure figure("arm", "The simulated arm under a load of 0.5 N", "time, ms", "place, mm");
  for (int k = 0; k < 200; ++k) {
    arm.step(dt);
    const double x_new = arm.pose().p.x(), v_new = arm.v().x();
    // The discretised law: balance at the end of the step.
    EXPECT_NEAR(m * (v_new - v) / dt,
                p.hand_stiffness_N_m * (0.004 - x_new) + p.hand_damping_Ns_m * (0.1 - v_new) + 0.5, 1e-9);
    EXPECT_NEAR(x_new, x + dt * v_new, 1e-15);
    x = x_new;
    v = v_new;
    law_v = (m / dt * law_v + p.hand_stiffness_N_m * (0.004 - law_x) + p.hand_damping_Ns_m * 0.1 + 0.5) /
            (m / dt + p.hand_damping_Ns_m + p.hand_stiffness_N_m * dt);
    law_x += dt * law_v;
    EXPECT_NEAR(x, law_x, 1e-9);
    figure.law("implicit Euler", k + 1, law_x * 1e3);
    if (k % 5 == 4) figure.run("arm", k + 1, x * 1e3);
  }
}

TEST(ArmModel, EnergyNeverGrowsAgainstAPassiveWall) {
  for (double wall_stiffness : {100.0, 400.0, 1000.0}) {
    ArmModel arm(calm());
    arm.place(Pose{Vec3(0.02, 0, 0), Quat::Identity()}, none, wide);
    HandGoal goal;
    goal.pose.p = Vec3(-0.003, 0, 0);  // presses into the wall at x < 0
    arm.set_goal(goal);
    auto total = [&] {
      const double depth = std::max(0.0, -arm.pose().p.x());
      return arm.energy() + 0.5 * wall_stiffness * depth * depth;
    };
    double last = total(), gained = 0;
    const double first = last;
    for (int k = 0; k < 2000; ++k) {
      const double depth = std::max(0.0, -arm.pose().p.x());
      arm.set_load(Vec3(wall_stiffness * depth, 0, 0), none);
      arm.step(dt);
      const double now = total();
      ASSERT_LE(now, last + 1e-12 + 1e-9 * first) << wall_stiffness << " N/m, tick " << k;
      gained = std::max(gained, now - last);
      last = now;
    }
    const double k_hand = arm.parameters().hand_stiffness_N_m;
    EXPECT_TRUE(test::held("energy gained in a tick at a wall", gained, first + 1e-3, 1e-9));
    EXPECT_TRUE(test::held("an arm that presses a wall, m",
                           std::abs(arm.pose().p.x() + 0.003 * k_hand / (k_hand + wall_stiffness)), 1, 1e-9));
  }
}

TEST(SimulatedDevice, ComesToRestAtAWallFeltThroughItsEncoder) {
  // Quantised and tracked position, one tick of delay, gate left out: the loop a servo closes.
  SimulatedDevice device(calm());
  device.place(Pose{Vec3(0.02, 0, 0), Quat::Identity()}, none, Vec3::Constant(1));
  HandGoal goal;
  goal.pose.p = Vec3(-0.003, 0, 0);
  device.guide(goal);
  const double wall = 400, start = device.arm().energy();
  double late_speed = 0;
  for (int k = 0; k < 4000; ++k) {
    device.advance(dt);
    const double depth = std::max(0.0, -device.read().pose.p.x());
    device.write(Vec3(wall * depth, 0, 0), none);
    ASSERT_LE(device.arm().energy(), start);
    if (k > 3000) late_speed = std::max(late_speed, device.arm().v().norm());
  }
  EXPECT_LT(late_speed, 1e-3);
  const double quantum = device.profile().resolution_m;
  EXPECT_NEAR(device.arm().pose().p.x(), -0.0015, quantum);
}

TEST(SimulatedDevice, ReportsWithItsResolution) {
  SimulatedDevice device(calm());
  device.place(Pose(), none, wide);
  HandGoal goal;
  goal.pose.p = Vec3(0.01234567, 0, 0);
  device.guide(goal);
  for (int k = 0; k < 3000; ++k) device.advance(dt);
  const double quantum = device.profile().resolution_m;
  const double counts = device.read().pose.p.x() / quantum;
  EXPECT_NEAR(counts, std::round(counts), 1e-6);
  EXPECT_NEAR(device.read().pose.p.x(), 0.01234567, 0.5 * quantum + 1e-9);
  EXPECT_NEAR(device.read().v.norm(), 0, 1e-9);
}

TEST(SimulatedDevice, VelocityFollowsASteadyMotion) {
  SimulatedDevice device(calm());
  device.place(Pose(), none, wide);
  HandGoal goal;
  goal.v = Vec3(0.05, 0, 0);
  Vec3 mean = none;
  for (int k = 0; k < 1000; ++k) {
    goal.pose.p += dt * goal.v;
    device.guide(goal);
    device.advance(dt);
    if (k >= 500) mean += device.read().v / 500;
  }
  EXPECT_NEAR((mean - goal.v).norm(), 0, 2e-4);
  EXPECT_NEAR((device.read().pose.p - goal.pose.p).norm(), 0, 60e-6);  // no lag beyond a count
}

TEST(ArmModel, StopsAtTheEndOfItsReach) {
  ArmModel arm(calm());
  arm.place(Pose(), none, omni_profile().workspace_m);
  HandGoal goal;
  goal.pose.p = Vec3(0, 0, 0.2);
  arm.set_goal(goal);
  for (int k = 0; k < 2000; ++k) arm.step(dt);
  EXPECT_NEAR(arm.pose().p.z(), 0.035, 1e-15);
  goal.stops = false;
  arm.set_goal(goal);
  for (int k = 0; k < 2000; ++k) arm.step(dt);
  EXPECT_NEAR(arm.pose().p.z(), 0.2, 1e-9);
}

TEST(ArmModel, FrictionHoldsAndNeverDrives) {
  ArmParameters p = calm();
  p.arm_friction_N = 0.26;
  ArmModel arm(p);
  arm.place(Pose(), none, wide);
  arm.set_load(Vec3(0.25, 0, 0), none);
  for (int k = 0; k < 1000; ++k) arm.step(dt);
  EXPECT_EQ(arm.pose().p.x(), 0);  // sticks
  arm.set_load(Vec3(1.0, 0, 0), none);
  for (int k = 0; k < 3000; ++k) arm.step(dt);
  EXPECT_EQ(arm.v().norm(), 0);  // stuck again, where friction can make up the balance
  EXPECT_LE(std::abs(1.0 - p.hand_stiffness_N_m * arm.pose().p.x()), 0.26);
  const double resting = arm.pose().p.x();
  for (int k = 0; k < 1000; ++k) arm.step(dt);
  EXPECT_EQ(arm.pose().p.x(), resting);
}

TEST(ArmModel, StaysStableForAnyStepAndLoad) {
  testing::Random random(5);
  ArmModel arm(simulated_arm(1));
  arm.place(Pose(), none, wide);
  for (int k = 0; k < 20000; ++k) {
    arm.set_load(random.vector(3.3), random.vector(0.2));
    arm.step(1e-4 + 0.01 * (random.next() + 1));
    ASSERT_LT(arm.pose().p.norm(), 0.05);
    ASSERT_NEAR(arm.pose().q.norm(), 1, 1e-12);
  }
  arm.set_load(Vec3(NAN, 0, 0), none);
  arm.step(dt);
  EXPECT_TRUE(arm.pose().p.allFinite());
}

TEST(ArmModel, TremorStaysWithinItsAmplitude) {
  ArmModel arm(simulated_arm(0));
  arm.place(Pose(), none, wide);
  double most = 0;
  for (int k = 0; k < 5000; ++k) {
    arm.step(dt);
    most = std::max(most, arm.pose().p.norm());
  }
  EXPECT_GT(most, 5e-6);
  EXPECT_LT(most, 2 * std::sqrt(3.0) * arm.parameters().tremor_m);
}

TEST(SimulatedDevice, SameCallsGiveTheSameBits) {
  SimulatedDevice a(simulated_arm(0)), b(simulated_arm(0));
  for (SimulatedDevice* d : {&a, &b}) d->place(Pose(), none, wide);
  testing::Random random(9);
  for (int k = 0; k < 2000; ++k) {
    const Vec3 force = random.vector(1), torque = random.vector(0.01);
    for (SimulatedDevice* d : {&a, &b}) {
      d->write(force, torque);
      d->advance(dt);
    }
    ASSERT_EQ(a.read().pose.p, b.read().pose.p);
    ASSERT_EQ(a.read().pose.q.coeffs(), b.read().pose.q.coeffs());
  }
}

TEST(MakeDevice, KnowsItsKindsAndNamesThem) {
  for (const std::string& kind : device_kinds()) EXPECT_EQ(make_device(kind, 0).device->profile().name, kind);
  try {
    make_device("omny", 0);
    FAIL();
  } catch (const InputError& e) {
    EXPECT_STREQ(e.what(),
                 "no device \"omny\"; there are: simulated mouse touch forcedimension haply spacemouse gamepad");
  }
}

}  // namespace
}  // namespace insula
