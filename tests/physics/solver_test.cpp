// SPDX-License-Identifier: GPL-3.0-or-later
// The constraint solver: thousands of random problems against the laws themselves, convergence against an accurate
// solution, and independence of the warm start.
#include "core/testing/held.h"
#include "tests/physics/random_problem.h"

namespace insula {
namespace {

using namespace test;

TEST(Solver, RandomProblemsObeyTheirLaws) {
  Random random(11);
  int solved = 0, friction_blocks = 0, stuck = 0, slipping = 0, open = 0;
  for (int trial = 0; trial < 3000; ++trial) {
    const ConstraintProblem p = random_problem(random, 0.6);
    for (const Block& b : p.blocks) friction_blocks += b.law == LawKind::friction;
    SolveWorkspace ws;
    ws.lambda.assign(std::size_t(p.rows), 0.0);
    const SolveStats stats = solve_to(p, ws, 200000, 1e-13, trial % 2 == 1);
    ASSERT_LT(stats.sweeps, 200000) << "trial " << trial << " does not converge, residual " << stats.residual_m;
    const double error = law_error(p, ws.lambda);
    ASSERT_TRUE(test::held("random problems obey their laws", error, 1, 1e-8)) << "trial " << trial;
    EXPECT_LT(stats.residual_m, 1e-9) << "trial " << trial;
    for (int i = 0; i < p.rows; ++i) {  // delta that it reports is W lambda + delta_free
      double d = p.delta_free[std::size_t(i)];
      for (int j = 0; j < p.rows; ++j) d += p.w_at(i, j) * ws.lambda[std::size_t(j)];
      ASSERT_NEAR(ws.delta[std::size_t(i)], d, 1e-11 * (1 + std::abs(d)));
    }
    for (const Block& b : p.blocks) {
      if (b.law != LawKind::patch) continue;
      double pressed = 0;
      for (int i = b.row - b.normals; i < b.row; ++i) pressed += ws.lambda[std::size_t(i)];
      const double force = std::hypot(ws.lambda[std::size_t(b.row)], ws.lambda[std::size_t(b.row + 1)]);
      (pressed <= 0 ? open : force < (1 - 1e-6) * b.friction * pressed ? stuck : slipping) += 1;
    }
    ++solved;
  }
  EXPECT_EQ(solved, 3000);
  EXPECT_GT(friction_blocks, 2000);
  EXPECT_GT(stuck, 100);
  EXPECT_GT(slipping, 1000);
  EXPECT_GT(open, 100);
}

TEST(Solver, ConvergesToTheAccurateSolution) {
  Random random(21);
  for (int trial = 0; trial < 200; ++trial) {
    const ConstraintProblem p = random_problem(random, 0.4);
    const bool conjugate = trial % 2 == 1;
    SolveWorkspace exact;
    exact.lambda.assign(std::size_t(p.rows), 0.0);
    solve_to(p, exact, 500000, 1e-15, conjugate);
    double force = 0;
    for (double l : exact.lambda) force = std::max(force, std::abs(l));
    double last = 1e300;
    for (const double tolerance : {1e-3, 1e-6, 1e-9}) {
      SolveWorkspace ws;
      ws.lambda.assign(std::size_t(p.rows), 0.0);
      const SolveStats stats = solve_to(p, ws, 500000, tolerance, conjugate);
      double error = 0;
      for (int i = 0; i < p.rows; ++i)
        error = std::max(error, std::abs(ws.lambda[std::size_t(i)] - exact.lambda[std::size_t(i)]));
      // The least eigenvalue of W is 0.05 or more and rows move by `tolerance` at most; Gauss-Seidel's rate is the
      // rest.
      EXPECT_TRUE(test::held("error over the tolerance asked for", error, tolerance * std::max(1.0, force), 1e4))
          << trial;
      // A sweep may meet the solution by chance; whoever goes on from there leaves it by no more than the tolerance.
      EXPECT_LE(error, std::max(last * (1 + 1e-9), tolerance * std::max(1.0, force))) << trial;
      EXPECT_LE(stats.residual_m, 1e2 * tolerance) << trial;
      last = std::max(error, 1e-13);
    }
    // A few sweeps never do worse than the bound says, and never leave the laws' bounds.
    SolveWorkspace few;
    few.lambda.assign(std::size_t(p.rows), 0.0);
    const SolveStats stats = solve_to(p, few, 3, 0, conjugate);
    EXPECT_LE(stats.sweeps, 3);
    expect_bounds(p, few.lambda);
  }
}

TEST(Solver, ResultDoesNotDependOnTheWarmStart) {
  Random random(31);
  for (int trial = 0; trial < 200; ++trial) {
    const ConstraintProblem p = random_problem(random, 0.3);
    SolveWorkspace cold, warm;
    cold.lambda.assign(std::size_t(p.rows), 0.0);
    for (int i = 0; i < p.rows; ++i) warm.lambda.push_back(random.uniform(-3, 3));
    solve_to(p, cold, 500000, 1e-14, trial % 2 == 1);
    solve_to(p, warm, 500000, 1e-14, trial % 4 > 1);  // both, and one against the other
    double force = 1e-300;
    for (double l : cold.lambda) force = std::max(force, std::abs(l));
    for (int i = 0; i < p.rows; ++i)
      EXPECT_TRUE(test::held("solution from any warm start",
                             std::abs(cold.lambda[std::size_t(i)] - warm.lambda[std::size_t(i)]), force, 1e-8))
          << trial;
    // From its own solution one sweep is enough.
    SolveWorkspace again;
    again.lambda = cold.lambda;
    EXPECT_LE(solve_to(p, again, 100, 1e-12, trial % 2 == 1).sweeps, 1) << trial;
  }
}

TEST(Solver, SameInputSameBits) {
  Random random(41);
  for (int trial = 0; trial < 50; ++trial) {
    const ConstraintProblem p = random_problem(random, 0.5), copy = p;
    SolveWorkspace a, b;
    a.lambda.assign(std::size_t(p.rows), 0.1);
    b.lambda.assign(std::size_t(p.rows), 0.1);
    b.delta.assign(500, 7.0);  // what lies in the workspace does not matter
    solve_to(p, a, 50, 1e-12, trial % 2 == 1);
    solve_to(copy, b, 50, 1e-12, trial % 2 == 1);
    EXPECT_EQ(a.lambda, b.lambda);
  }
}

TEST(Solver, EmptyProblem) {
  ConstraintProblem p;
  p.resize(0);
  SolveWorkspace ws;
  const SolveStats s = solve_to(p, ws, 10, 1e-9, true);
  EXPECT_EQ(s.sweeps, 0);
  EXPECT_EQ(s.residual_m, 0);
}

// Two contacts of one rigid block pressed against a wall with a known answer: the load is shared by moments.
TEST(Solver, KnownAnswer) {
  ConstraintProblem p;
  p.resize(2);
  // A body of unit mass and inertia, contacts at arms +1 and -2: W = J J^T, delta_free = push of a force 3 at the
  // centre.
  p.w[0] = 1 + 1;
  p.w[1] = 1 - 2;
  p.w[std::size_t(p.stride)] = 1 - 2;
  p.w[std::size_t(p.stride) + 1] = 1 + 4;
  p.delta_free = {-3, -3};
  for (int i = 0; i < 2; ++i) {
    Block b;
    b.id = std::uint64_t(i);
    b.row = i;
    b.lower = 0;
    p.blocks.push_back(b);
  }
  SolveWorkspace ws;
  ws.lambda.assign(2, 0.0);
  solve_to(p, ws, 1000, 1e-15, false);
  EXPECT_TRUE(test::held("two contacts share a load", std::abs(ws.lambda[0] - 2), 1,
                         1e-12));  // lambda_0 + lambda_1 = 3, lambda_0 = 2 lambda_1
  EXPECT_NEAR(ws.lambda[1], 1, 1e-12);
}

// Two heavy jaws close on a stack of light nodes, in each direction alike: row k joins part k and part k + 1,
//   W = c (2 on the diagonal, -1 beside it), at the ends c + c_jaw instead of 2 c.
// The jaws come together by `close` each and shear by `shear` each; the same force goes through the whole stack.
constexpr double node_compliance = 1, jaw_compliance = 0.01;

ConstraintProblem squeezed_stack(int nodes, double friction, double close, double shear) {
  ConstraintProblem p;
  const int contacts = nodes + 1, size = friction > 0 ? 3 : 1;
  p.resize(size * contacts);
  for (int k = 0; k < contacts; ++k) {
    Block b;
    b.id = std::uint64_t(k);
    b.row = size * k;
    b.lower = 0;
    if (friction > 0) {
      b.law = LawKind::friction;
      b.friction = friction;
    }
    p.blocks.push_back(b);
    const bool end = k == 0 || k == nodes;
    for (int d = 0; d < size; ++d) {
      const int r = size * k + d;
      p.w[std::size_t(r * p.stride + r)] = end ? node_compliance + jaw_compliance : 2 * node_compliance;
      if (k > 0) p.w[std::size_t(r * p.stride + r - size)] = -node_compliance;
      if (k < nodes) p.w[std::size_t(r * p.stride + r + size)] = -node_compliance;
      if (end) p.delta_free[std::size_t(r)] = d == 0 ? -close : d == 1 ? shear : 0;
    }
  }
  return p;
}

TEST(Solver, ConjugateDirectionsSolveAHardStackInFarFewerSweeps) {
  const double close = 0.02;
  struct Case {
    double friction, shear;
  };
  for (const Case& c : {Case{0, 0}, Case{0.4, 0.004}, Case{0.4, 0.02}}) {  // none; sticks; slips
    SCOPED_TRACE("friction " + std::to_string(c.friction) + ", shear " + std::to_string(c.shear));
    const ConstraintProblem p = squeezed_stack(12, c.friction, close, c.shear);
    const double normal = close / jaw_compliance;
    const double tangent = c.friction > 0 ? -std::min(c.shear / jaw_compliance, c.friction * normal) : 0;
    const auto error = [&](const std::vector<double>& lambda) {
      double e = 0;
      for (const Block& b : p.blocks) {
        e = std::max(e, std::abs(lambda[std::size_t(b.row)] - normal));
        if (c.friction > 0)
          e = std::max(
              {e, std::abs(lambda[std::size_t(b.row + 1)] - tangent), std::abs(lambda[std::size_t(b.row + 2)])});
      }
      return e / normal;
    };
    SolveWorkspace ws;
    ws.lambda.assign(std::size_t(p.rows), 0.0);
    const SolveStats stats = solve_to(p, ws, 3000, 1e-11, true);
    EXPECT_LT(stats.sweeps, 1000);
    EXPECT_TRUE(test::held("a stiff stack between jaws", error(ws.lambda), 1, 1e-6));
    EXPECT_LT(law_error(p, ws.lambda), 1e-6);
    expect_bounds(p, ws.lambda);

    // Plain block Gauss-Seidel with eight times as many sweeps does worse by orders of magnitude.
    SolveWorkspace plain;
    plain.lambda.assign(std::size_t(p.rows), 0.0);
    solve_to(p, plain, 8 * stats.sweeps, 0, false);
    EXPECT_GT(error(plain.lambda), 1000 * error(ws.lambda));
  }
}

// However early it stops, no bound is left: the last thing done is a sweep, never a step along a direction.
TEST(Solver, BoundsHoldAfterAnyNumberOfSweeps) {
  Random random(61);
  for (int trial = 0; trial < 200; ++trial) {
    const ConstraintProblem p =
        trial % 4 == 0 ? squeezed_stack(3 + trial % 20, 0.3, 0.02, 0.0005 * (trial % 50)) : random_problem(random, 0.6);
    for (const int sweeps : {1, 2, 3, 5, 8, 13, 40, 120}) {
      SolveWorkspace ws;
      ws.lambda.assign(std::size_t(p.rows), 0.0);
      EXPECT_LE(solve_to(p, ws, sweeps, 0, true).sweeps, sweeps);
      expect_bounds(p, ws.lambda);
    }
  }
}

}  // namespace
}  // namespace insula
