// SPDX-License-Identifier: GPL-3.0-or-later
// What is added to the servo's force: exactly so much, in the right direction, and nothing where nothing is known.
#include "haptic_server/force_output.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "haptic_server/devices/arm_model.h"
#include "haptic_server/safety_gate.h"

namespace insula {
namespace {

constexpr double tick = 1e-3;
const Vec3 up = Vec3::UnitZ(), still = Vec3::Zero();

TEST(ForceOutput, WithoutAnythingDeclaredTheForceGoesThroughAsItIs) {
  ForceOutput force_output;
  const Vec3 f(0.1, -0.2, 0.05);
  EXPECT_EQ(force_output.apply(DeviceProfile{}, tick, f, Vec3(0.1, 0, 0), up, true), f);
  EXPECT_EQ(force_output.apply(DeviceProfile{}, tick, f, still, up, false), f);
}

TEST(ForceOutput, ScalesByWhatTheSceneDeclares) {
  ForceOutput force_output;
  force_output.set({3, 0.8, true});
  EXPECT_EQ(force_output.apply(DeviceProfile{}, tick, Vec3(0.1, 0, 0), still, up, true), Vec3(3 * 0.1, 0, 0));
}

TEST(ForceOutput, TakesOffAShareOfTheDevicesFrictionAlongTheMotion) {
  ForceOutput force_output;
  DeviceProfile device;
  device.friction_N = 0.26;
  const Vec3 fast = Vec3(3, 0, 4).normalized() * 0.05;
  EXPECT_LT((force_output.apply(device, tick, still, fast, up, true) - 0.8 * 0.26 * Vec3(0.6, 0, 0.8)).norm(), 1e-15);
  EXPECT_LT(
      (force_output.apply(device, tick, still, 0.1 * fast, up, true) - 0.5 * 0.8 * 0.26 * Vec3(0.6, 0, 0.8)).norm(),
      1e-15)
      << "at half of the slow speed, half";
  EXPECT_EQ(force_output.apply(device, tick, still, still, up, true), still);
  EXPECT_EQ(force_output.apply(device, tick, still, Vec3(std::nan(""), 0, 0), up, true), still);
}

/// With the device's friction still on it, a compensated arm that was pushed comes to rest: what is taken off never
/// drives.
TEST(ForceOutput, ACompensatedArmStillComesToRest) {
  ArmParameters p;
  p.profile = omni_profile();
  p.profile.friction_N = p.arm_friction_N = 0.26;
  p.hand_stiffness_N_m = p.hand_damping_Ns_m = 0;  // nobody holds it
  ArmModel arm(p);
  arm.place({}, Vec3::Zero(), Vec3::Constant(10));
  ForceOutput force_output;
  arm.set_load(Vec3(2, 0, 0), Vec3::Zero());
  for (int i = 0; i < 30; ++i) arm.step(tick);
  const double thrown = arm.v().norm();
  ASSERT_GT(thrown, 0.1);
  double energy = arm.energy();
  for (int i = 0; i < 3000; ++i) {
    arm.set_load(force_output.apply(p.profile, tick, still, arm.v(), up, true), Vec3::Zero());
    arm.step(tick);
    ASSERT_LE(arm.energy(), energy);
    energy = arm.energy();
  }
  EXPECT_EQ(arm.v().norm(), 0);
}

TEST(ForceOutput, CarriesTheArmsWeight) {
  ForceOutput force_output;
  DeviceProfile device;
  device.weight_N = 0.7;
  const Vec3 scene_up = Vec3(1, 2, 2) / 3;
  EXPECT_LT((force_output.apply(device, tick, still, still, scene_up, true) - 0.7 * scene_up).norm(), 1e-15);
}

TEST(ForceOutput, AKnockIsADampedSineAndEnds) {
  ForceOutput force_output;
  force_output.start_transient(Vec3(0, 2, 0), severing_transient);
  for (int i = 0; i < 200; ++i) {
    const double t = i * tick, want = t < 5 * severing_transient.decay_s
                                          ? severing_transient.amplitude_N * std::exp(-t / severing_transient.decay_s) *
                                                std::sin(2 * std::numbers::pi * severing_transient.frequency_Hz * t)
                                          : 0;
    const Vec3 f = force_output.apply(DeviceProfile{}, tick, still, still, up, true);
    ASSERT_NEAR(f.y(), want, 1e-12) << i;
    ASSERT_EQ(f.x(), 0);
  }
}

TEST(ForceOutput, AStrongerKnockTakesOverAndALostSourceSilencesIt) {
  ForceOutput force_output;
  force_output.start_transient(Vec3::UnitX(), latching_transient);
  force_output.apply(DeviceProfile{}, tick, still, still, up, true);
  force_output.start_transient(Vec3::UnitY(), severing_transient);  // weaker: not heard
  EXPECT_EQ(force_output.apply(DeviceProfile{}, tick, still, still, up, true).y(), 0);
  EXPECT_EQ(force_output.apply(DeviceProfile{}, tick, still, still, up, false), still);
  EXPECT_EQ(force_output.apply(DeviceProfile{}, tick, still, still, up, true), still) << "it does not come back";
  force_output.start_transient(Vec3(std::nan(""), 0, 0), latching_transient);
  force_output.start_transient(still, latching_transient);
  force_output.apply(DeviceProfile{}, tick, still, still, up, true);
  EXPECT_EQ(force_output.apply(DeviceProfile{}, tick, still, still, up, true), still);
}

TEST(Onset, OnlyAfterSomeTimeOutOfTouch) {
  Onset onset;
  EXPECT_FALSE(onset.met(tick, 0));
  EXPECT_TRUE(onset.met(tick, 0.1));
  EXPECT_FALSE(onset.met(tick, 0.1));
  for (int i = 0; i < 20; ++i) EXPECT_FALSE(onset.met(tick, 0)) << "a chattering contact";
  EXPECT_FALSE(onset.met(tick, 0.1));
  for (int i = 0; i < 60; ++i) onset.met(tick, 0);
  EXPECT_TRUE(onset.met(tick, 0.1));
}

TEST(ForceOutput, AWallKnocksAndTissueDoesNot) {
  ConstraintProblem p;
  p.resize(2);
  ToolTerms tool;
  tool.hand = 1;
  tool.compliance = Mat6::Identity() / 300;
  tool.jacobian.setZero(2, 6);
  tool.jacobian(0, 2) = tool.jacobian(1, 0) = 1;
  p.tools.push_back(tool);
  for (int i = 0; i < 2; ++i) {
    Block b;
    b.id = std::uint64_t(i);
    b.row = i;
    b.lower = 0;
    p.blocks.push_back(b);
  }
  p.w[0] = 1 / 300.0;                                      // a wall
  p.w[std::size_t(p.stride) + 1] = 1 / 300.0 + 1 / 100.0;  // tissue
  EXPECT_DOUBLE_EQ(hardness(p, 1, {0.2, 0.1}), 1);
  EXPECT_DOUBLE_EQ(hardness(p, 1, {0.1, 0.2}), 0.25);
  EXPECT_EQ(hardness(p, 1, {0, 0}), 0);
  EXPECT_EQ(hardness(p, 0, {1, 1}), 0) << "no tool of that hand";
  EXPECT_EQ(impact_transient(0.05, 0.25).amplitude_N, 0);
  EXPECT_DOUBLE_EQ(impact_transient(0.05, 1).amplitude_N, 0.3);
  EXPECT_DOUBLE_EQ(impact_transient(0.02, 1).amplitude_N, 0.12) << "in proportion to the speed";
  EXPECT_EQ(impact_transient(-1, 1).amplitude_N, 0) << "it goes away";
  EXPECT_EQ(impact_transient(10, 1).amplitude_N, 0.5) << "at most";
}

}  // namespace
}  // namespace insula
