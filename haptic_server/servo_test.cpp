// SPDX-License-Identifier: GPL-3.0-or-later
// The haptic tick: equation 7 against a fresh solve, the engine's force, warm start by block id, bounds.
#include "haptic_server/servo.h"

#include <gtest/gtest.h>

#include <limits>

#include "core/testing/held.h"
#include "haptic_server/problem_for_test.h"
#include "haptic_server/welded_problem_for_test.h"
#include "tests/figures/figure.h"

namespace insula {
namespace {

ServoInput still(const ConstraintProblem& p) {
  ServoInput in;
  for (const ToolTerms& t : p.tools) {
    in.device[std::size_t(t.hand)] = t.device;
    in.connected[std::size_t(t.hand)] = true;
  }
  return in;
}

/// Force and torque on the hand by matrices of any size and a separate solve, as an independent form of equation 7.
Vec6 wrench_by_hand(const ConstraintProblem& p, const ServoInput& in, int hand) {
  ConstraintProblem shifted = p;
  VecX free = Eigen::Map<const VecX>(p.delta_free.data(), p.rows);
  std::vector<Vec6> d;
  for (const ToolTerms& t : p.tools) {
    d.push_back(displacement(t.device, in.device[std::size_t(t.hand)]));
    free += t.jacobian * (t.gain * d.back());
  }
  for (int i = 0; i < p.rows; ++i) shifted.delta_free[std::size_t(i)] = free[i];
  std::fill(shifted.lambda.begin(), shifted.lambda.end(), 0.0);
  testing::solve_as_engine(shifted);
  const VecX lambda = Eigen::Map<const VecX>(shifted.lambda.data(), p.rows);
  for (std::size_t t = 0; t < p.tools.size(); ++t) {
    const ToolTerms& tool = p.tools[t];
    if (tool.hand != hand) continue;
    const Pose end = displaced(tool.free, tool.gain * d[t] + tool.compliance * (tool.jacobian.transpose() * lambda));
    return tool.stiffness * displacement(in.device[std::size_t(hand)], end);
  }
  return Vec6::Zero();
}

ServoSettings tight() {
  ServoSettings s;
  s.max_sweeps = 5000;
  s.max_operations = 1e12;
  s.tolerance_m = 1e-14;
  return s;
}

TEST(Servo, ForceEqualsTheEnginesWhenTheDeviceStandsStill) {
  ConstraintProblem p = testing::two_tool_problem(20, 60, 1, 4);
  testing::solve_as_engine(p);
  Servo servo;  // the settings of the real server
  servo.set_problem(&p);
  const ServoInput in = still(p);
  for (int tick = 0; tick < 20; ++tick) {
    const ServoResult r = servo.tick(in);
    ASSERT_TRUE(r.solved);
    for (int hand = 0; hand < 2; ++hand) {
      const ToolTerms& tool = p.tools[std::size_t(hand)];
      const VecX lambda = Eigen::Map<const VecX>(p.lambda.data(), p.rows);
      const Pose end = displaced(tool.free, tool.compliance * (tool.jacobian.transpose() * lambda));
      const Vec6 engine = tool.stiffness * displacement(tool.device, end);
      EXPECT_GT(engine.head<3>().norm(), 1e-3);  // contacts push, else the test says nothing
      EXPECT_TRUE(test::held("force of a hand that is still, N",
                             (r.hand[std::size_t(hand)].force - engine.head<3>()).norm(), 1, 1e-6));
      EXPECT_TRUE(test::held("torque of a hand that is still, N m",
                             (r.hand[std::size_t(hand)].torque - engine.tail<3>()).norm(), 1, 1e-6));
    }
  }
}

TEST(Servo, EquationSevenAgainstAFreshSolve) {
  testing::Random random(7);
  test::Figure figure("equation7", "The servo's force against a fresh solve, random problems and hands",
                      "force of a fresh solve, N", "force of the servo, N");
  figure.law("the same", 0, 0);
  for (std::uint64_t seed = 1; seed <= 10; ++seed) {
    ConstraintProblem p = testing::two_tool_problem(12, 20, seed, int(seed % 4));
    testing::solve_as_engine(p);
    Servo servo(tight());
    servo.set_problem(&p);
    for (int tick = 0; tick < 5; ++tick) {
      ServoInput in = still(p);
      for (Pose& pose : in.device) {
        const Vec3 move = random.vector(1e-3), turn = random.vector(0.02);
        pose = displaced(pose, (Vec6() << move, turn).finished());
      }
      const ServoResult r = servo.tick(in);
      for (int hand = 0; hand < 2; ++hand) {
        const Vec6 expected = wrench_by_hand(p, in, hand);
        ASSERT_TRUE(r.hand[std::size_t(hand)].valid);
        EXPECT_NEAR((r.hand[std::size_t(hand)].force - expected.head<3>()).norm(), 0, 1e-8);
        figure.law("the same", expected.head<3>().norm(), expected.head<3>().norm());
        figure.run("servo", expected.head<3>().norm(), r.hand[std::size_t(hand)].force.norm());
        EXPECT_NEAR((r.hand[std::size_t(hand)].torque - expected.tail<3>()).norm(), 0, 1e-8);
      }
    }
  }
}

TEST(Servo, HandsFeelEachOtherThroughTheSharedProblem) {
  ConstraintProblem p = testing::two_tool_problem(12, 20);
  testing::solve_as_engine(p);
  Servo servo(tight());
  servo.set_problem(&p);
  ServoInput in = still(p);
  const Vec3 before = servo.tick(in).hand[0].force;
  in.device[1].p += Vec3(0, 0, -2e-3);
  EXPECT_GT((servo.tick(in).hand[0].force - before).norm(), 1e-5);
}

TEST(Servo, FreeSpaceIsTheCouplingAlone) {
  ConstraintProblem p = testing::two_tool_problem(0, 0);
  Servo servo;
  servo.set_problem(&p);
  ServoInput in = still(p);
  in.device[0].p += Vec3(1e-3, 0, 0);
  const ServoResult r = servo.tick(in);
  const ToolTerms& t = p.tools[0];
  const Vec6 d = (Vec6() << 1e-3, 0, 0, 0, 0, 0).finished();
  const Vec6 expected = t.stiffness * displacement(in.device[0], displaced(t.free, t.gain * d));
  EXPECT_NEAR((r.hand[0].force - expected.head<3>()).norm(), 0, 1e-12);
}

TEST(Servo, AppliesTheToolsOffset) {
  ConstraintProblem p = testing::two_tool_problem(4, 4);
  testing::solve_as_engine(p);
  const Pose offset{Vec3(0.01, -0.02, 0.1), from_rotation_vector(Vec3(0.3, 0.1, -0.2))};
  Servo plain, shifted;
  plain.set_problem(&p);
  shifted.set_problem(&p, {offset, offset});
  ServoInput in = still(p), moved = in;
  for (Pose& pose : moved.device) {  // device = tool * offset^-1
    pose.q = pose.q * offset.q.conjugate();
    pose.p = pose.p - pose.q * offset.p;
  }
  const ServoResult a = plain.tick(in), b = shifted.tick(moved);
  for (std::size_t i = 0; i < 2; ++i) {
    EXPECT_NEAR((a.hand[i].force - b.hand[i].force).norm(), 0, 1e-9);
    const Vec3 arm = in.device[i].p - moved.device[i].p;
    EXPECT_NEAR((a.hand[i].torque + arm.cross(a.hand[i].force) - b.hand[i].torque).norm(), 0, 1e-9);
  }
}

TEST(Servo, WarmStartIsMappedByBlockId) {
  ConstraintProblem p = testing::two_tool_problem(3, 4);
  testing::solve_as_engine(p);
  Servo servo(tight());
  servo.set_problem(&p);
  ServoInput in = still(p);
  in.device[0].p.z() -= 1e-3;
  servo.tick(in);
  const std::vector<double> solved = servo.lambda();

  // The same blocks in another order, one gone, one new.
  ConstraintProblem q;
  q.resize(p.rows - 1);
  q.tools = p.tools;
  for (ToolTerms& t : q.tools) t.jacobian.setZero(q.rows, 6);
  int row = 0;
  std::vector<double> expected(std::size_t(q.rows), 0);
  for (std::size_t k = p.blocks.size(); k-- > 0;) {
    Block b = p.blocks[k];
    if (b.id == 5001) continue;
    for (int i = 0; i < b.rows(); ++i) {
      expected[std::size_t(row + i)] = solved[std::size_t(b.row + i)];
      q.lambda[std::size_t(row + i)] = -123;  // the engine's: must not be used for known blocks
    }
    if (b.id == 5002) {
      b.id = 777;
      expected[std::size_t(row)] = -123;  // new: the engine's counts
    }
    b.row = row;
    row += b.rows();
    q.blocks.push_back(b);
  }
  ASSERT_EQ(row, q.rows);
  servo.set_problem(&q);
  ASSERT_EQ(servo.lambda().size(), expected.size());
  for (std::size_t i = 0; i < expected.size(); ++i) EXPECT_EQ(servo.lambda()[i], expected[i]) << i;

  // The mapping survives a moment without a problem (that is how buffers change hands), but not a reset.
  servo.set_problem(nullptr);
  servo.set_problem(&q);
  EXPECT_EQ(servo.lambda()[0], expected[0]);
  servo.set_problem(nullptr);
  servo.reset();
  servo.set_problem(&q);
  EXPECT_EQ(servo.lambda()[0], -123);
}

TEST(Servo, SweepsAreBounded) {
  ConstraintProblem p = testing::two_tool_problem(60, 60);
  ASSERT_EQ(p.rows, 240);
  ServoSettings s;
  s.tolerance_m = 0;
  s.max_operations = 240.0 * 240 * 7;
  Servo servo(s);
  servo.set_problem(&p);
  EXPECT_EQ(servo.tick(still(p)).stats.sweeps, 7);
  s.max_sweeps = 3;
  Servo shorter(s);
  shorter.set_problem(&p);
  EXPECT_EQ(shorter.tick(still(p)).stats.sweeps, 3);
}

// A closing clip has more rows than a tick has sweeps for: what they leave is a step's worth of force that comes too
// late.
TEST(Servo, OneNewtonStepEndsWhatSweepsLeave) {
  ConstraintProblem p = testing::with_clip(180, 4, 6);
  testing::solve_as_engine(p);
  ServoSettings sweeps;
  sweeps.max_sweeps = 20;
  sweeps.conjugate = true;
  ServoSettings newton = sweeps;
  newton.newton_unknowns = 200;
  ServoSettings few = newton;
  few.newton_unknowns = 10;  // fewer than press
  ServoResult r[3];
  int k = 0;
  for (const ServoSettings& s : {sweeps, newton, few}) {
    Servo servo(s);
    servo.set_problem(&p);
    ServoInput in = still(p);
    for (int tick = 0; tick < 10; ++tick) {  // 0.1 m/s
      in.device[1].p += Vec3(5e-5, -3e-5, 8e-5);
      r[k] = servo.tick(in);
    }
    ++k;
  }
  EXPECT_GT(r[0].stats.residual_m, 1e-7);
  EXPECT_LT(r[1].stats.residual_m, 1e-9);
  EXPECT_EQ(r[1].stats.newton_steps, 1);
  EXPECT_GT(r[2].stats.residual_m, 1e-7);
  EXPECT_LE(r[2].stats.sweeps, 20);
}

TEST(Servo, RefusesWhatIsTooLargeOrTooFarOrNotFinite) {
  Servo servo;
  EXPECT_FALSE(servo.tick(ServoInput{}).solved);
  ConstraintProblem big = testing::two_tool_problem(80, 20);
  servo.set_problem(&big);
  EXPECT_FALSE(servo.tick(still(big)).solved);

  ConstraintProblem p = testing::two_tool_problem(4, 4);
  servo.set_problem(&p);
  ServoInput in = still(p);
  in.device[0].p.x() += 0.2;
  ServoResult r = servo.tick(in);
  EXPECT_FALSE(r.hand[0].valid);
  EXPECT_TRUE(r.hand[1].valid);
  EXPECT_EQ(r.hand[0].force, Vec3(0, 0, 0));
  in = still(p);
  in.device[1].q.w() = std::numeric_limits<double>::quiet_NaN();
  r = servo.tick(in);
  EXPECT_TRUE(r.hand[0].valid);
  EXPECT_FALSE(r.hand[1].valid);
  in = still(p);
  in.connected[0] = false;
  r = servo.tick(in);
  EXPECT_FALSE(r.hand[0].valid);
  EXPECT_TRUE(r.hand[1].valid);

  // A poisoned problem: no force, and no poison left behind.
  ConstraintProblem poisoned = p;
  poisoned.delta_free[0] = std::numeric_limits<double>::quiet_NaN();
  servo.set_problem(&poisoned);
  r = servo.tick(still(p));
  EXPECT_FALSE(r.hand[0].valid && !r.hand[0].force.allFinite());
  servo.set_problem(&p);
  r = servo.tick(still(p));
  EXPECT_TRUE(r.hand[0].valid);
  EXPECT_TRUE(r.hand[0].force.allFinite());
}

TEST(Servo, SameInputsGiveTheSameBits) {
  ConstraintProblem p = testing::two_tool_problem(20, 60);
  Servo a, b;
  a.set_problem(&p);
  b.set_problem(&p);
  testing::Random random(3);
  ServoInput in = still(p);
  for (int tick = 0; tick < 50; ++tick) {
    in.device[0].p += random.vector(1e-4);
    const ServoResult x = a.tick(in), y = b.tick(in);
    for (std::size_t i = 0; i < 2; ++i) {
      EXPECT_EQ(x.hand[i].force, y.hand[i].force);
      EXPECT_EQ(x.hand[i].torque, y.hand[i].torque);
    }
  }
}

}  // namespace
}  // namespace insula
