// SPDX-License-Identifier: GPL-3.0-or-later
// The constraint solver: the exact local contact against a search over directions, thousands of random problems against
// the laws themselves, convergence against an accurate solution, and independence of the warm start.
#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <cmath>

#include "core/base/random.h"
#include "core/constraint/friction.h"
#include "core/constraint/solve.h"

namespace insula {
namespace {

MatX random_matrix(Random& random, int rows, int columns) {
  MatX m(rows, columns);
  for (int i = 0; i < rows; ++i)
    for (int j = 0; j < columns; ++j) m(i, j) = random.uniform(-1, 1);
  return m;
}

LocalContact local(const Mat3& w, const Vec3& q) { return {w(0, 0), w(0, 1), w(0, 2), w(1, 1), w(1, 2), w(2, 2), q[0], q[1], q[2]}; }

/// Largest violation of the contact laws, relative to the sizes at hand.
double contact_error(const Vec3& delta, const Vec3& lambda, double mu, double length, double force) {
  double error = std::max(-delta[0] / length, -lambda[0] / force);
  error = std::max(error, std::min(std::abs(delta[0]) / length, std::abs(lambda[0]) / force));
  const Eigen::Vector2d slip = delta.tail<2>(), f = lambda.tail<2>();
  error = std::max(error, (f.norm() - mu * lambda[0]) / force);  // cone
  if (lambda[0] > 1e-12 * force && slip.norm() > 1e-9 * length && mu > 0)  // slips: on the cone, opposing
    error = std::max({error, std::abs(f.norm() - mu * lambda[0]) / force, (f + mu * lambda[0] * slip / slip.norm()).norm() / force * std::min(1.0, slip.norm() / length)});
  return error;
}

// All sliding solutions by search over the direction of friction: gap closed and slip against it.
std::vector<Vec3> search(const Mat3& w, const Vec3& q, double mu) {
  std::vector<Vec3> found;
  if (q[0] >= 0) return {Vec3::Zero()};
  const Vec3 stick = -w.ldlt().solve(q);
  if (stick[0] >= 0 && stick.tail<2>().norm() <= mu * stick[0]) found.push_back(stick);
  struct Slide {
    Vec3 lambda, delta;
    double across, along;
  };
  const auto at = [&](double angle) {
    const Eigen::Vector2d d(std::cos(angle), std::sin(angle));
    const double reduced = w(0, 0) + mu * (w(0, 1) * d[0] + w(0, 2) * d[1]);
    Slide s;
    const double n = -q[0] / reduced;
    s.lambda = Vec3(n, mu * n * d[0], mu * n * d[1]);
    s.delta = w * s.lambda + q;
    s.across = s.delta[1] * d[1] - s.delta[2] * d[0];
    s.along = s.delta[1] * d[0] + s.delta[2] * d[1];
    return s;
  };
  const int n = 4000;
  const double step = 2 * 3.14159265358979323846 / n;
  Slide before = at(0);
  for (int i = 1; i <= n; ++i) {
    const Slide now = at(i * step);
    if ((before.across > 0) != (now.across > 0) && before.lambda[0] > 0 && now.lambda[0] > 0) {
      double low = (i - 1) * step, high = i * step;
      for (int k = 0; k < 60; ++k) {
        const double middle = 0.5 * (low + high);
        ((at(middle).across > 0) == (before.across > 0) ? low : high) = middle;
      }
      const Slide s = at(0.5 * (low + high));
      if (s.along < 0 && std::abs(s.across) < 1e-9 * (s.delta.norm() + q.norm())) found.push_back(s.lambda);
    }
    before = now;
  }
  return found;
}

TEST(LocalContact, IsTheSolutionThatASearchFinds) {
  Random random(1);
  int stick = 0, slide = 0, open = 0, several = 0;
  for (int trial = 0; trial < 5000; ++trial) {
    const MatX a = random_matrix(random, 3, 5);
    const Mat3 w = a * a.transpose() + 0.02 * Mat3::Identity();
    const Vec3 q(random.uniform(-1, 0.3), random.uniform(-1, 1), random.uniform(-1, 1));
    const double mu = trial % 10 == 0 ? 0.0 : random.uniform(0.02, 1.0);
    Vec3 lambda;
    solve_contact(local(w, q), mu, lambda.data());
    const Vec3 delta = w * lambda + q;
    const double force = q.norm() / w.trace(), length = q.norm();
    ASSERT_LT(contact_error(delta, lambda, mu, length, std::max(force, lambda.norm())), 1e-8) << "trial " << trial << " mu " << mu << " lambda " << lambda.transpose() << " delta " << delta.transpose();
    if (mu == 0) continue;
    const auto all = search(w, q, mu);
    ASSERT_FALSE(all.empty()) << trial;
    double nearest = 1e300;
    for (const Vec3& s : all) nearest = std::min(nearest, (s - lambda).norm());
    EXPECT_LT(nearest, 1e-7 * std::max(force, lambda.norm())) << "trial " << trial << ": " << all.size() << " found by search";
    several += all.size() > 1;
    if (q[0] >= 0) ++open;
    else if (delta.tail<2>().norm() < 1e-9) ++stick;
    else ++slide;
  }
  EXPECT_GT(stick, 200);
  EXPECT_GT(slide, 1000);
  EXPECT_GT(open, 200);
}

TEST(LocalContact, DegenerateInputsGiveFiniteForces) {
  const Vec3 q(-1, 0.5, 0.2);
  for (const double mu : {0.0, 0.3, 5.0})
    for (const Mat3& w : {Mat3(Mat3::Zero()), Mat3(Vec3(1, 0, 0).asDiagonal()), Mat3(Mat3::Ones()), Mat3(1e-12 * Mat3::Identity()), Mat3(Vec3(1, 1e-14, 1).asDiagonal())}) {
      Vec3 lambda;
      solve_contact(local(w, q), mu, lambda.data());
      EXPECT_TRUE(lambda.allFinite());
      EXPECT_GE(lambda[0], 0);
      EXPECT_LE(lambda.tail<2>().norm(), mu * lambda[0] * (1 + 1e-12));
    }
}

/// Contacts, fibres, holds and links among a few bodies of several degrees of freedom: W = H A^-1 H^T plus a little on
/// the diagonal, so that the solution is one.
ConstraintProblem random_problem(Random& random, double friction) {
  ConstraintProblem p;
  int rows = 0;
  const int blocks = 2 + int(random.below(9));
  std::vector<Block> made;
  for (int i = 0; i < blocks; ++i) {
    Block b;
    b.id = std::uint64_t(100 + i);
    b.row = rows;
    switch (random.below(6)) {
      case 0: break;                                                                     // bilateral
      case 1: b.compliance = random.uniform(0.1, 2); break;                              // two-sided spring
      case 2: b.compliance = random.uniform(0.1, 2); b.upper = 0; break;                 // fibre
      case 3: b.lower = 0; break;                                                        // contact without friction
      case 4: b.upper = random.uniform(0.1, 1); b.lower = -b.upper; break;               // plastic hold
      default: b.law = LawKind::friction; b.friction = friction * random.uniform(0.1, 1);
    }
    rows += b.rows();
    made.push_back(b);
  }
  p.resize(rows);
  p.blocks = made;
  // Each row acts on two of the bodies: sparse coupling as in a scene.
  const int bodies = 3 + int(random.below(4)), dof = 6;
  MatX h = MatX::Zero(rows, bodies * dof);
  for (const Block& b : made) {
    const int one = int(random.below(std::uint32_t(bodies))), two = int(random.below(std::uint32_t(bodies)));
    for (int k = 0; k < b.rows(); ++k) {
      h.row(b.row + k).segment(one * dof, dof) += random_matrix(random, 1, dof);
      if (two != one) h.row(b.row + k).segment(two * dof, dof) -= random_matrix(random, 1, dof);
    }
  }
  const MatX w = h * h.transpose() + 0.05 * MatX::Identity(rows, rows);
  for (int i = 0; i < rows; ++i) {
    for (int j = 0; j < rows; ++j) p.w[std::size_t(i * p.stride + j)] = 0.5 * (w(i, j) + w(j, i));
    p.delta_free[std::size_t(i)] = random.uniform(-1, 1);
  }
  return p;
}

double law_error(const ConstraintProblem& p, const std::vector<double>& lambda) {
  VecX delta(p.rows);
  double length = 1e-300, force = 1e-300;
  for (int i = 0; i < p.rows; ++i) {
    delta[i] = p.delta_free[std::size_t(i)];
    for (int j = 0; j < p.rows; ++j) delta[i] += p.w_at(i, j) * lambda[std::size_t(j)];
    length = std::max(length, std::abs(p.delta_free[std::size_t(i)]));
    force = std::max(force, std::abs(lambda[std::size_t(i)]));
  }
  double error = 0;
  for (const Block& b : p.blocks) {
    const double* l = lambda.data() + b.row;
    if (b.law == LawKind::friction) {
      error = std::max(error, contact_error(delta.segment<3>(b.row), Vec3(l[0], l[1], l[2]), b.friction, length, force));
      continue;
    }
    const double d = (delta[b.row] + b.compliance * l[0]) / length;
    error = std::max({error, (b.lower - l[0]) / force, (l[0] - b.upper) / force});
    if (l[0] <= b.lower) error = std::max(error, -d);       // pushed against its lower bound: may open
    else if (l[0] >= b.upper) error = std::max(error, d);
    else error = std::max(error, std::abs(d));
  }
  return error;
}

SolveStats solve_to(const ConstraintProblem& p, SolveWorkspace& ws, int sweeps, double tolerance, bool conjugate) {
  ws.reserve(p.rows);
  return solve(p, p.delta_free, {sweeps, tolerance, conjugate}, ws);
}

TEST(Solver, RandomProblemsObeyTheirLaws) {
  Random random(11);
  int solved = 0, friction_blocks = 0;
  for (int trial = 0; trial < 3000; ++trial) {
    const ConstraintProblem p = random_problem(random, 0.6);
    for (const Block& b : p.blocks) friction_blocks += b.law == LawKind::friction;
    SolveWorkspace ws;
    ws.lambda.assign(std::size_t(p.rows), 0.0);
    const SolveStats stats = solve_to(p, ws, 200000, 1e-13, trial % 2 == 1);
    ASSERT_LT(stats.sweeps, 200000) << "trial " << trial << " does not converge, residual " << stats.residual_m;
    const double error = law_error(p, ws.lambda);
    ASSERT_LT(error, 1e-8) << "trial " << trial;
    EXPECT_LT(stats.residual_m, 1e-9) << "trial " << trial;
    for (int i = 0; i < p.rows; ++i) {  // delta that it reports is W lambda + delta_free
      double d = p.delta_free[std::size_t(i)];
      for (int j = 0; j < p.rows; ++j) d += p.w_at(i, j) * ws.lambda[std::size_t(j)];
      ASSERT_NEAR(ws.delta[std::size_t(i)], d, 1e-11 * (1 + std::abs(d)));
    }
    ++solved;
  }
  EXPECT_EQ(solved, 3000);
  EXPECT_GT(friction_blocks, 2000);
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
      for (int i = 0; i < p.rows; ++i) error = std::max(error, std::abs(ws.lambda[std::size_t(i)] - exact.lambda[std::size_t(i)]));
      // The least eigenvalue of W is 0.05 or more and rows move by `tolerance` at most; Gauss-Seidel's rate is the rest.
      EXPECT_LT(error, 1e4 * tolerance * std::max(1.0, force)) << trial;
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
    for (const Block& b : p.blocks) {
      const double* l = few.lambda.data() + b.row;
      if (b.law == LawKind::box) { EXPECT_TRUE(l[0] >= b.lower && l[0] <= b.upper); }
      else { EXPECT_LE(std::hypot(l[1], l[2]), b.friction * l[0] * (1 + 1e-12)); }
    }
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
    solve_to(p, warm, 500000, 1e-14, trial % 4 > 1);  // both ways, and one against the other
    double force = 1e-300;
    for (double l : cold.lambda) force = std::max(force, std::abs(l));
    for (int i = 0; i < p.rows; ++i) EXPECT_NEAR(cold.lambda[std::size_t(i)], warm.lambda[std::size_t(i)], 1e-8 * force) << trial;
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
  // A body of unit mass and inertia, contacts at arms +1 and -2: W = J J^T, delta_free = push of a force 3 at the centre.
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
  EXPECT_NEAR(ws.lambda[0], 2, 1e-12);  // lambda_0 + lambda_1 = 3, lambda_0 = 2 lambda_1
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

void expect_bounds(const ConstraintProblem& p, const std::vector<double>& lambda) {
  for (const Block& b : p.blocks) {
    const double* l = lambda.data() + b.row;
    if (b.law == LawKind::box) {
      EXPECT_GE(l[0], b.lower);
      EXPECT_LE(l[0], b.upper);
    } else {
      EXPECT_GE(l[0], 0);
      EXPECT_LE(std::hypot(l[1], l[2]), b.friction * l[0] * (1 + 1e-12));
    }
  }
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
          e = std::max({e, std::abs(lambda[std::size_t(b.row + 1)] - tangent), std::abs(lambda[std::size_t(b.row + 2)])});
      }
      return e / normal;
    };
    SolveWorkspace ws;
    ws.lambda.assign(std::size_t(p.rows), 0.0);
    const SolveStats stats = solve_to(p, ws, 3000, 1e-11, true);
    EXPECT_LT(stats.sweeps, 1000);
    EXPECT_LT(error(ws.lambda), 1e-6);
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
    const ConstraintProblem p = trial % 4 == 0 ? squeezed_stack(3 + trial % 20, 0.3, 0.02, 0.0005 * (trial % 50)) : random_problem(random, 0.6);
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
