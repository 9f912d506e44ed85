// SPDX-License-Identifier: GPL-3.0-or-later
// Directions of contact between steps: a tool that slides round a ball feels its normal where it is, not where the
// problem has it.
#include "haptic_server/contact_frame_extrapolation.h"

#include <gtest/gtest.h>

#include <cmath>

#include "haptic_server/problem_for_test.h"
#include "haptic_server/servo.h"

namespace insula {
namespace {

constexpr double ball_m = 0.03, step_rad = 0.05;
const Vec3 axis = Vec3(0.2, 1, -0.3).normalized(), up = axis.unitOrthogonal(), reach(1e-3, 2e-3, -4e-3);

Vec3 normal_at(double angle) { return from_rotation_vector(angle * axis) * up; }

/// A tool that has gone by `angle` round a hard ball, pressed on it by `deep`; a contact of three rows at `reach` from
/// its origin, in the directions that it has after `turned` more steps of step_rad.
ConstraintProblem on_ball(double angle, double deep = 0, double steps_ahead = 0) {
  ConstraintProblem p;
  p.resize(3);
  p.step_s = 0.02;
  Pose device;
  device.p = (ball_m - deep) * normal_at(angle);
  ToolTerms t = testing::held_tool(1, device, 3);
  t.swept_displacement = device.p - (ball_m - deep) * normal_at(angle - step_rad);
  t.gain.setIdentity();
  const Vec3 n = normal_at(angle + steps_ahead * step_rad), along = axis.cross(n),
             directions[3] = {n, along, n.cross(along)};
  for (int k = 0; k < 3; ++k) t.jacobian.row(k) << directions[k].transpose(), reach.cross(directions[k]).transpose();
  testing::set_w(p, MatX(t.jacobian * t.compliance * t.jacobian.transpose()));
  p.delta_free[0] = -deep;
  p.prediction_horizon_steps = steps_ahead;
  p.blocks.push_back({.id = 7, .law = LawKind::friction});
  for (int k = 0; k < 3; ++k) p.blocks[0].frame_rotation[std::size_t(k)] = float(step_rad * axis[k]);
  p.tools.push_back(t);
  testing::solve_as_engine(p);
  return p;
}

std::array<Vec6, 2> gone(const ConstraintProblem& from, double share) {
  std::array<Vec6, 2> out{Vec6::Zero(), Vec6::Zero()};
  out[0].head<3>() = share * from.tools[0].swept_displacement;
  return out;
}

TEST(ContactFrameExtrapolation, TurnAboutTheirContactPointAsFarAsTheToolGoes) {
  for (const double steps_ahead : {0.0, 0.4}) {
    const ConstraintProblem problem = on_ball(step_rad, 0, steps_ahead);
    ContactFrameExtrapolation rows(servo_max_rows);
    rows.begin(problem, {});
    for (const double share : {0.0, 0.4, 1.0, -0.5}) {
      rows.extrapolate(gone(problem, share));
      const ConstraintProblem there = on_ball((1 + share) * step_rad);
      for (int k = 0; k < 3; ++k) {
        const Vec6 row = rows.jacobian(0).row(k).transpose(), expected = there.tools[0].jacobian.row(k).transpose();
        // Two terms of the rotation, and the device goes straight on.
        EXPECT_LT((row - expected).head<3>().norm(), std::pow(step_rad, 3)) << k << ' ' << share;
        EXPECT_LT((row - expected).tail<3>().norm(), std::pow(step_rad, 3) * reach.norm()) << k << ' ' << share;
        EXPECT_NEAR(row.head<3>().norm(), 1, 1e-12);
      }
    }
  }
}

TEST(ContactFrameExtrapolation, NothingTurnsThatIsNotSaidToTurn) {
  const auto stays = [](const ConstraintProblem& problem, const std::array<GraspedBody, 2>& grasped = {}) {
    ContactFrameExtrapolation rows(servo_max_rows);
    rows.begin(problem, grasped);
    rows.extrapolate(gone(problem, 1));
    return rows.jacobian(0).topRows(3) == problem.tools[0].jacobian;
  };
  const ConstraintProblem problem = on_ball(step_rad);
  EXPECT_FALSE(stays(problem));
  ConstraintProblem still = problem;
  still.blocks[0].frame_rotation = {};
  EXPECT_TRUE(stays(still)) << "no turn is known";
  EXPECT_TRUE(stays(problem, {GraspedBody{.any = true}, GraspedBody{}})) << "of a grasped body";
  ConstraintProblem rests = problem;
  rests.tools[0].swept_displacement.setZero();
  EXPECT_TRUE(stays(rests)) << "the hand rests";
}

// Without friction the force lies along the normal, wherever the tool has gone since the problem.
TEST(ContactFrameExtrapolation, TheForceRoundABallKeepsToItsNormal) {
  constexpr double deep = 1e-3;
  double off[2];
  for (const bool extrapolated : {false, true}) {
    ServoSettings settings = ServoSettings::beyond_equation_7();
    settings.force_crossfade.within_s = 0;
    settings.substep.extrapolate_frames = extrapolated;
    Servo servo(settings);
    const ConstraintProblem problem = on_ball(step_rad, deep);
    servo.set_problem(&problem, {}, 1e-3);
    ServoInput in;
    in.connected[1] = true;
    off[extrapolated] = 0;
    for (int k = 1; k <= 20; ++k) {
      const double angle = step_rad * (1 + k / 20.0);
      in.device[1].p = (ball_m - deep) * normal_at(angle);
      const Vec3 force = servo.tick(in).hand[1].force;
      ASSERT_GT(force.norm(), 0.1);
      off[extrapolated] = std::max(off[extrapolated], force.normalized().cross(normal_at(angle)).norm());
    }
  }
  EXPECT_GT(off[0], 0.9 * step_rad);
  EXPECT_LT(off[1], 0.1 * step_rad);
}

}  // namespace
}  // namespace insula
