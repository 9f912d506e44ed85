// SPDX-License-Identifier: GPL-3.0-or-later
// Hard problems by each method, against closed forms: Gauss-Seidel alone stalls on most of them, Newton takes a few
// steps.
#include "tests/problems/hard_problems.h"

namespace insula {
namespace {

using namespace test;

constexpr double tolerance = 1e-10;  // m
const struct {
  const char* name;
  SolveSettings settings;
} methods[] = {{"sweeps, Newton", {150, tolerance, false, 30}},
               {"conjugate, Newton", {150, tolerance, true, 30}},
               {"Newton at once", {1, tolerance, false, 30}}};

SolveStats solve_cold(const ConstraintProblem& p, const SolveSettings& settings, SolveWorkspace& ws) {
  ws.reserve(p.rows);
  ws.lambda.assign(std::size_t(p.rows), 0.0);
  return solve(p, p.delta_free, settings, ws);
}

// Jaws a hundred to ten thousand times stiffer than the nodes between them.
TEST(HardProblems, JawsOnAStack) {
  for (const double jaw : {1e-2, 1e-4})
    for (const double shear : {1e-5, 1e-4}) {  // sticks, slips
      const Jaws jaws{24, jaw, 1e-4, shear, 0.4};
      const ConstraintProblem p = jaws.problem();
      for (const auto& m : methods) {
        SCOPED_TRACE(m.name);
        SolveSettings fine = m.settings;
        fine.tolerance_m = 1e-13;  // a small residual is a large error in the most rigid direction
        SolveWorkspace ws;
        const SolveStats s = solve_cold(p, fine, ws);
        EXPECT_LE(s.residual_m, fine.tolerance_m);
        EXPECT_LE(s.newton_steps, 6);
        expect_bounds(p, ws.lambda);
        for (const Block& b : p.blocks) {
          EXPECT_NEAR(ws.lambda[std::size_t(b.row)], jaws.normal(), 1e-6 * jaws.normal());
          EXPECT_NEAR(ws.lambda[std::size_t(b.row + 1)], jaws.tangent(), 1e-6 * jaws.normal());
          EXPECT_NEAR(ws.lambda[std::size_t(b.row + 2)], 0, 1e-6 * jaws.normal());
        }
      }
      SolveWorkspace sweeps;
      solve_cold(p, {5000, tolerance, false, 0}, sweeps);
      EXPECT_GT(std::abs(sweeps.lambda[0] - jaws.normal()), 0.01 * jaws.normal()) << "no hard problem any more";
    }
}

// Who knows that sweeps stall has Newton after eight of them, and the same result.
TEST(HardProblems, NewtonSoonSparesSweeps) {
  const Jaws jaws{24, 1e-4, 1e-4, 1e-5, 0.4};
  const ConstraintProblem p = jaws.problem();
  SolveSettings settings{150, 1e-13, true, 30};
  SolveWorkspace late, soon;
  const SolveStats a = solve_cold(p, settings, late);
  settings.newton_soon = true;
  const SolveStats b = solve_cold(p, settings, soon);
  EXPECT_TRUE(a.stalled && b.stalled);
  EXPECT_GE(a.sweeps, 16);
  EXPECT_LE(b.sweeps, 8 + 4 * b.newton_steps);
  EXPECT_LE(b.residual_m, settings.tolerance_m);
  for (std::size_t i = 0; i < late.lambda.size(); ++i)
    EXPECT_NEAR(soon.lambda[i], late.lambda[i], 1e-6 * jaws.normal());
}

TEST(HardProblems, MassRatiosOfTenThousandAndAMillion) {
  for (const double ratio : {1e4, 1e6})
    for (const int light : {1, 5, 20}) {
      const Column column{light, ratio};
      const ConstraintProblem p = column.problem();
      for (const auto& m : methods) {
        SCOPED_TRACE(std::string(m.name) + ", " + std::to_string(light));
        SolveWorkspace ws;
        const SolveStats s = solve_cold(p, m.settings, ws);
        EXPECT_LE(s.residual_m, tolerance);
        EXPECT_LE(s.newton_steps, 8);
        for (int k = 0; k <= light; ++k)
          EXPECT_NEAR(ws.lambda[std::size_t(k)], column.force(k), 1e-7 * column.force(k)) << k;
      }
      SolveWorkspace sweeps;
      solve_cold(p, {5000, tolerance, false, 0}, sweeps);
      EXPECT_GT(std::abs(sweeps.lambda[0] - column.force(0)), 0.01 * column.force(0)) << "no hard problem any more";
    }
}

// 36 contacts on a rigid body, W of rank six out of 108: how they share the load is open, the sums and the motion are
// not. The push goes through the friction's limit: sticks below mu m g, slides with (push - mu m g) / m above.
TEST(HardProblems, RedundantContactsStickAndSlip) {
  const double limit = Slab::mu * Slab::mass * Slab::gravity;
  for (const double push : {0.0, 0.5 * limit, 0.99 * limit, 1.01 * limit, 1.5 * limit, 4 * limit}) {
    const ConstraintProblem p = Slab{6, push}.problem();
    const double motion = std::max(0.0, push - limit) / Slab::mass;
    for (const auto& m : methods) {
      SCOPED_TRACE(std::string(m.name) + ", push " + std::to_string(push));
      SolveWorkspace ws;
      const SolveStats s = solve_cold(p, m.settings, ws);
      EXPECT_LE(s.residual_m, tolerance);
      EXPECT_LE(s.residual_N, 1e-8);
      expect_bounds(p, ws.lambda);
      double normal = 0, tangent = 0;
      for (const Block& b : p.blocks) {
        normal += ws.lambda[std::size_t(b.row)];
        tangent += ws.lambda[std::size_t(b.row + 1)];
        EXPECT_NEAR(ws.delta[std::size_t(b.row)], 0, 1e-8);
        EXPECT_NEAR(ws.delta[std::size_t(b.row + 1)], motion, 1e-7);
        EXPECT_NEAR(ws.delta[std::size_t(b.row + 2)], 0, 1e-7);
      }
      EXPECT_NEAR(normal, Slab::mass * Slab::gravity, 1e-7);
      EXPECT_NEAR(tangent, -std::min(push, limit), 1e-7);
    }
  }
}

// 120 contacts with friction, 360 rows: to the laws' own accuracy, and the same answer by each method.
TEST(HardProblems, ThreeHundredAndSixtyRows) {
  Random random(3);
  const ConstraintProblem p = crowded(random, 120, 90, 0.01);
  SolveWorkspace reference;
  const SolveStats plain = solve_cold(p, {20000, 1e-13, false, 0}, reference);
  ASSERT_LT(plain.residual_m, 1e-11);
  ASSERT_GT(plain.sweeps, 300);
  double force = 0;
  for (const double l : reference.lambda) force = std::max(force, std::abs(l));
  for (const auto& m : methods) {
    SCOPED_TRACE(m.name);
    SolveWorkspace ws;
    const SolveStats s = solve_cold(p, m.settings, ws);
    EXPECT_LE(s.residual_m, tolerance);
    EXPECT_LE(s.residual_N, 10 * tolerance / 0.3);
    EXPECT_LT(law_error(p, ws.lambda), 1e-9);
    expect_bounds(p, ws.lambda);
    for (std::size_t i = 0; i < ws.lambda.size(); ++i)
      EXPECT_NEAR(ws.lambda[i], reference.lambda[i], 1e-7 * force) << i;
  }
}

// All laws mixed, patches and bounds too: Newton's answer is that of many sweeps.
TEST(HardProblems, NewtonAgreesWithSweepsOnRandomProblems) {
  Random random(71);
  int newton = 0;
  for (int trial = 0; trial < 1000; ++trial) {
    const ConstraintProblem p = random_problem(random, 0.5);
    SolveWorkspace many, few;
    solve_cold(p, {200000, 1e-13, false, 0}, many);
    const SolveStats s = solve_cold(p, {1, 1e-12, false, 60}, few);
    newton += s.method == SolveMethod::newton;
    ASSERT_LT(s.residual_m, 1e-11) << trial;
    expect_bounds(p, few.lambda);
    double force = 1e-300;
    for (const double l : many.lambda) force = std::max(force, std::abs(l));
    for (std::size_t i = 0; i < few.lambda.size(); ++i)
      ASSERT_NEAR(few.lambda[i], many.lambda[i], 1e-7 * force) << trial;
  }
  EXPECT_GT(newton, 800);
}

// Where sweeps converge Newton is never called: the same bits with and without.
TEST(HardProblems, NewtonStaysAwayFromEasyProblems) {
  Random random(81);
  int compared = 0;
  for (int trial = 0; trial < 300; ++trial) {
    const ConstraintProblem p = random_problem(random, 0.5);
    SolveWorkspace with, without;
    if (solve_cold(p, {150, 1e-7, trial % 2 == 0, 0}, without).sweeps > 30) continue;
    const SolveStats s = solve_cold(p, {150, 1e-7, trial % 2 == 0, 20}, with);
    if (s.newton_steps > 0) continue;  // a last sweep within the tolerance need not have a residual within it
    EXPECT_EQ(with.lambda, without.lambda) << trial;
    ++compared;
  }
  EXPECT_GT(compared, 200);
}

// An impossible problem: two bilateral rows that contradict each other. Bounded work, finite numbers, no better answer
// claimed.
TEST(HardProblems, ContradictionEndsAndStaysFinite) {
  const ConstraintProblem p = problem_of(MatX::Constant(2, 2, 1), (VecX(2) << 1, -1).finished(), {Block{}, Block{}});
  for (const auto& m : methods) {
    SolveWorkspace ws;
    const SolveStats s = solve_cold(p, m.settings, ws);
    EXPECT_LE(s.newton_steps, m.settings.max_newton);
    EXPECT_GT(s.residual_m, 0.1);
    for (const double l : ws.lambda) EXPECT_TRUE(std::isfinite(l));
  }
}

// Two rows that are nearly one, and do not quite agree: the exact solution is 10 kN, along the null space of W.
TEST(HardProblems, NewtonStaysBelowItsBoundWhereRowsDependOnOneAnother) {
  ConstraintProblem p;
  p.resize(2);
  const double w[2][2] = {{1, 1}, {1, 1 + 1e-8}};
  for (int i = 0; i < 2; ++i) {
    for (int j = 0; j < 2; ++j) p.w[std::size_t(i * p.stride + j)] = w[i][j];
    p.blocks.push_back({.id = std::uint64_t(i + 1), .row = i});
  }
  p.delta_free = {-1e-3, -1.1e-3};
  for (const bool soon : {false, true}) {
    SolveWorkspace ws;
    ws.reserve(p.rows, true);
    ws.lambda.assign(2, 0.0);
    SolveSettings settings{.max_sweeps = 50, .tolerance_m = 1e-12, .max_newton = 5, .newton_soon = soon};
    settings.newton_bound = 100;
    solve(p, p.delta_free, settings, ws);
    for (const double x : ws.lambda) EXPECT_LT(std::abs(x), 100) << soon;
    settings.newton_bound = 1e5;
    solve(p, p.delta_free, settings, ws);
    EXPECT_GT(std::abs(ws.lambda[0]), 5e3) << "otherwise the bound means nothing";
  }
}

}  // namespace
}  // namespace insula
