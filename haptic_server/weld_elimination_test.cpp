// SPDX-License-Identifier: GPL-3.0-or-later
// Grasped bodies: elimination changes no force, and inertia is that of a tick.
#include "core/haptics/weld_elimination.h"

#include <gtest/gtest.h>

#include "haptic_server/servo.h"
#include "haptic_server/welded_problem_for_test.h"

namespace insula {
namespace {

using testing::with_clip;

TEST(WeldElimination, TheSameForcesWithoutItsRows) {
  testing::Random random(5);
  ServoSettings tight;
  tight.max_sweeps = 20000;
  tight.max_operations = 1e12;
  tight.tolerance_m = 1e-15;
  for (const int own : {0, 4}) {
    ConstraintProblem p = with_clip(8, own, 11);
    testing::solve_as_engine(p);
    EXPECT_EQ(first_weld_row(p, 0), own);
    WeldElimination weld_elimination(servo_max_rows);
    const ConstraintProblem& reduced = weld_elimination.eliminate(p);
    ASSERT_EQ(reduced.rows, p.rows - 6);
    EXPECT_TRUE(weld_elimination.grasped()[0].any);
    Servo full(tight), less(tight);
    full.set_problem(&p);
    less.set_problem(&reduced);
    for (int k = 0; k < 10; ++k) {
      ServoInput in;
      in.connected[1] = true;
      in.device[1] = displaced(Pose(), (Vec6() << random.vector(2e-4), random.vector(0.01)).finished());
      const ServoHand a = full.tick(in).hand[1], b = less.tick(in).hand[1];
      EXPECT_GT(a.force.norm(), 1e-3);
      EXPECT_NEAR((a.force - b.force).norm(), 0, 1e-6) << k;
      EXPECT_NEAR((a.torque - b.torque).norm(), 0, 1e-7) << k;
    }
  }
}

// A hand and its clip go along at one speed: nothing is to be felt, however long the next problem takes.
TEST(WeldElimination, InertiaIsNoAnchor) {
  ConstraintProblem p = with_clip(0, 0, 1);
  p.tools[0].free = p.tools[0].device;
  const Vec3 speed(0.02, 0, 0.01);
  for (int k = 0; k < 3; ++k) p.rate[std::size_t(k)] = speed[k];
  double force[2];
  for (const bool in_ticks : {false, true}) {
    Servo servo(in_ticks ? ServoSettings::beyond_equation_7() : ServoSettings());
    servo.set_problem(&p, {}, 1e-3);
    ServoInput in;
    in.connected[1] = true;
    for (int k = 1; k <= 33; ++k) {
      in.device[1].p = 1e-3 * k * speed;
      force[in_ticks] = servo.tick(in).hand[1].force.norm();
    }
  }
  EXPECT_GT(force[0], 0.04);  // 80 N/m times 0.74 mm
  EXPECT_LT(force[1], 1e-6);
}

// And when the hand stops, the clip comes to rest by it without swinging.
TEST(WeldElimination, ComesToRestWithoutSwinging) {
  ConstraintProblem p = with_clip(0, 0, 1);
  p.tools[0].free = p.tools[0].device;
  p.rate[0] = 0.02;
  Servo servo(ServoSettings::beyond_equation_7());
  servo.set_problem(&p, {}, 1e-3);
  ServoInput in;
  in.connected[1] = true;
  double least = 0, last = 0;
  for (int k = 0; k < 300; ++k) {
    last = servo.tick(in).hand[1].force.x();
    least = std::min(least, last);
  }
  EXPECT_NEAR(last, 0, 1e-6);
  EXPECT_GT(least, -1e-4);
}

TEST(WeldElimination, NothingElseIsTakenForAClip) {
  const ConstraintProblem none = testing::two_tool_problem(10, 10, 3);
  WeldElimination weld_elimination(servo_max_rows);
  EXPECT_EQ(&weld_elimination.eliminate(none), &none);
  for (const auto& change : {+[](ConstraintProblem& p) { p.blocks[3].upper = 0; },
                             +[](ConstraintProblem& p) { p.blocks[2].compliance = 1e-3; },
                             +[](ConstraintProblem& p) { p.retardation_time[5] = 0.02; },
                             +[](ConstraintProblem& p) { p.blocks[4].owner = 99; },
                             +[](ConstraintProblem& p) { p.blocks[4].role = BlockRole::other; },
                             +[](ConstraintProblem& p) { p.tools[0].jacobian.row(1).setZero(); }}) {
    ConstraintProblem p = with_clip(4, 0, 2);
    ASSERT_EQ(first_weld_row(p, 0), 0);
    change(p);
    EXPECT_EQ(&weld_elimination.eliminate(p), &p);
    EXPECT_FALSE(weld_elimination.grasped()[0].any);
  }
}

}  // namespace
}  // namespace insula
