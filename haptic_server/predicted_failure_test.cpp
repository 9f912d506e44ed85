// SPDX-License-Identifier: GPL-3.0-or-later
// A blade in a strand between two fixed points: both fail in the tick that the law says.
#include "haptic_server/predicted_failure.h"

#include <gtest/gtest.h>

#include "haptic_server/problem_for_test.h"
#include "haptic_server/servo.h"

namespace insula {
namespace {

constexpr double cut_force = 0.02, travel = 0.4e-3, stiffness = 300, gain = 0.9, step_s = 0.016;
constexpr std::uint64_t fibre_id = 70, blade_id = 71;

/// A massless tool whose blade is along x in a strand. The strand has a stretch of its own, which no tool changes.
ConstraintProblem blade_in_strand(double device_x, double stretch = 0, double strength = 0) {
  ConstraintProblem p;
  p.resize(2);
  p.step_s = step_s;
  ToolTerms tool = testing::held_tool(1, {Vec3(device_x, 0, 0), Quat::Identity()}, 2);
  tool.jacobian(1, 0) = 1;
  p.tools.push_back(tool);
  MatX w = MatX::Zero(2, 2);
  w(1, 1) = tool.compliance(0, 0);
  testing::set_w(p, w);
  Block fibre;
  fibre.id = fibre_id;
  fibre.row = 0;
  fibre.role = BlockRole::fibre;
  fibre.compliance = 0.05;
  fibre.upper = 0;
  fibre.failure_group = 1;
  fibre.failure_force = float(strength);
  p.delta_free[0] = stretch;
  p.lambda[0] = -stretch / fibre.compliance;
  Block blade;
  blade.id = blade_id;
  blade.row = 1;
  blade.role = BlockRole::contact;
  blade.lower = -cut_force;
  blade.upper = 0;
  blade.failure_group = 1;
  blade.failure_travel = float(travel);
  p.blocks = {fibre, blade};
  return p;
}

ServoSettings predicting() {
  ServoSettings s;
  s.substep.predict_failure = true;
  return s;
}

struct Hand {
  Servo servo{predicting()};
  double x = 0;
  double force(double by) {
    x += by;
    ServoInput input;
    input.connected[1] = true;
    input.device[1] = {Vec3(x, 0, 0), Quat::Identity()};
    return servo.tick(input).hand[1].force.x();
  }
};

// The coupling stretches until the strand yields at cut_force. From then on the blade moves as the free tool does.
TEST(PredictedFailure, ABladePartsAStrandInItsTick) {
  const ConstraintProblem p = blade_in_strand(0);
  Hand hand;
  hand.servo.set_problem(&p);
  constexpr double by = 10e-6;
  const double parts_at = (cut_force / stiffness + travel) / gain;  // of the device, m
  for (int tick = 1; tick <= 80; ++tick) {
    const double force = hand.force(by), lag = stiffness * (1 - gain) * hand.x;  // of the free tool behind the device
    const double resistance = std::min(stiffness * gain * hand.x, cut_force);
    if (hand.x < parts_at - by) {
      EXPECT_NEAR(force, -lag - resistance, 1e-9) << tick;
    } else if (hand.x > parts_at + 2 * by) {
      EXPECT_NEAR(force, -lag, 1e-9) << tick;
    }
  }
}

TEST(PredictedFailure, ABladeThatIsDrawnBackIsFreeAndThenCutsOn) {
  const ConstraintProblem p = blade_in_strand(0);
  Hand hand;
  hand.servo.set_problem(&p);
  while (hand.x < 0.3e-3) hand.force(10e-6);
  const double turned = hand.x;
  for (int tick = 0; tick < 20; ++tick) {
    const double force = hand.force(-10e-6);
    // The coupling lets go of the strand before the blade moves back.
    const double lag = stiffness * (1 - gain) * hand.x;
    EXPECT_NEAR(force, -lag - std::max(0.0, cut_force - stiffness * gain * (turned - hand.x)), 1e-9) << tick;
  }
}

// The engine does not know yet, so its next problem still has the strand.
TEST(PredictedFailure, AProblemThatIsLateDoesNotMendTheStrand) {
  const ConstraintProblem first = blade_in_strand(0);
  Hand hand;
  hand.servo.set_problem(&first);
  while (hand.x < 0.7e-3) hand.force(10e-6);
  const double lag = stiffness * (1 - gain) * hand.x;
  EXPECT_NEAR(hand.force(0), -lag, 1e-9);
  const ConstraintProblem late = blade_in_strand(0.1e-3);
  hand.servo.set_problem(&late);
  for (int tick = 0; tick < 5; ++tick) EXPECT_NEAR(hand.force(0), -stiffness * (1 - gain) * (hand.x - 0.1e-3), 1e-9);
  // After some steps the engine must know. If it still sends the strand, it has not failed there.
  for (int tick = 0; tick < 70; ++tick) hand.force(0);
  const ConstraintProblem again = blade_in_strand(hand.x);
  hand.servo.set_problem(&again);
  hand.force(20e-6);
  EXPECT_LT(hand.force(0), -stiffness * 19e-6);
}

// Before the strand parts, it becomes as soft as the wear says: k (1 - travel / limit).
TEST(PredictedFailure, AWornStrandIsSofterAndWeaker) {
  constexpr double stretch = 0.5e-3, whole = stretch / 0.05;
  for (const bool weak : {false, true}) {
    const ConstraintProblem p = blade_in_strand(0, stretch, weak ? 1.2 * whole : 0);
    Hand hand;
    hand.servo.set_problem(&p);
    double worn = 0;
    for (int tick = 0; tick < 40; ++tick) {
      hand.force(10e-6);
      const double tension = -hand.servo.lambda()[0];
      EXPECT_NEAR(tension, whole * (1 - worn / travel), 1e-9) << tick;
      worn = std::clamp(gain * hand.x - cut_force / stiffness, 0.0, travel);
    }
    EXPECT_GT(worn, 0.5 * travel);
  }
}

TEST(PredictedFailure, AStrandThatIsPulledTooFarTears) {
  ConstraintProblem p = blade_in_strand(0, 0.5e-3, 0.009);  // 10 mN
  p.blocks[1].failure_travel = 0;
  p.blocks[1].lower = 0;
  Hand hand;
  hand.servo.set_problem(&p);
  hand.force(0);
  hand.force(0);
  EXPECT_EQ(hand.servo.lambda()[0], 0);
}

TEST(PredictedFailure, IsOffByDefault) {
  const ConstraintProblem p = blade_in_strand(0);
  Servo servo;
  servo.set_problem(&p);
  ServoInput input;
  input.connected[1] = true;
  input.device[1] = {Vec3(1.5e-3, 0, 0), Quat::Identity()};
  servo.tick(input);
  EXPECT_NEAR(servo.tick(input).hand[1].force.x(), -stiffness * (1 - gain) * 1.5e-3 - cut_force, 1e-9);
}

}  // namespace
}  // namespace insula
