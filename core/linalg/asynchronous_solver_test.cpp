// SPDX-License-Identifier: GPL-3.0-or-later
// The solver with a factor of another step: against dense algebra, with matrices that turn and change while it works.
#include "core/linalg/asynchronous_solver.h"
#include "core/testing/held.h"

#include <gtest/gtest.h>

#include <Eigen/Cholesky>
#include <random>

namespace insula {
namespace {

constexpr double tolerance = 1e-7;
constexpr int few = 4;  ///< iterations with the factor of the matrix itself, as rounded as it is

// A chain of boxes of nodes: positive definite, and badly enough conditioned that a diagonal would not do as a
// preconditioner.
struct System {
  static constexpr int nx = 7, ny = 4, nz = 4, nodes = nx * ny * nz;
  BlockMatrix a;
  MatX dense = MatX::Zero(3 * nodes, 3 * nodes);
  std::vector<std::pair<int, int>> pairs;
  std::vector<Mat3> block;  // of each pair, and of the diagonal

  explicit System(unsigned seed) {
    std::mt19937 random(seed);
    std::uniform_real_distribution<double> u(0.2, 1);
    const auto at = [](int x, int y, int z) { return (z * ny + y) * nx + x; };
    for (int z = 0; z < nz; ++z)
      for (int y = 0; y < ny; ++y)
        for (int x = 0; x < nx; ++x)
          for (int d = 0; d < 3; ++d) {
            const int to[3] = {x + (d == 0), y + (d == 1), z + (d == 2)};
            if (to[0] < nx && to[1] < ny && to[2] < nz) pairs.emplace_back(at(x, y, z), at(to[0], to[1], to[2]));
          }
    a.set_pattern(nodes, pairs);
    for (std::size_t k = 0; k < pairs.size(); ++k) block.push_back(Vec3(u(random), u(random), u(random)).asDiagonal());
    fill(std::vector<Mat3>(nodes, Mat3::Identity()), 0);
  }
  // Springs R_i B R_j^T between neighbours: the energy of differences in each node's own turned frame. `stiffer`
  // changes some.
  void fill(const std::vector<Mat3>& r, double stiffer) {
    dense.setZero();
    for (std::size_t k = 0; k < pairs.size(); ++k) {
      const auto [i, j] = pairs[k];
      const Mat3 b = block[k] * (k % 5 == 0 ? 1 + stiffer : 1.0);
      const Mat3 &ri = r[std::size_t(i)], &rj = r[std::size_t(j)];
      dense.block<3, 3>(3 * i, 3 * i) += ri * b * ri.transpose();
      dense.block<3, 3>(3 * j, 3 * j) += rj * b * rj.transpose();
      dense.block<3, 3>(3 * i, 3 * j) -= ri * b * rj.transpose();
      dense.block<3, 3>(3 * j, 3 * i) -= rj * b * ri.transpose();
    }
    dense.diagonal().array() += 1e-2;
    a.set_zero();
    for (int j = 0; j < nodes; ++j)
      for (int s = a.column_start(j); s < a.column_start(j + 1); ++s)
        Eigen::Map<Mat3>(a.block(s)) = dense.block<3, 3>(3 * a.row(s), 3 * j);
  }
};

std::vector<Mat3> turned(double angle) {
  std::vector<Mat3> r(System::nodes);
  for (int i = 0; i < System::nodes; ++i)
    r[std::size_t(i)] =
        from_rotation_vector(Vec3(angle, 0.3 * angle * i / System::nodes, -0.5 * angle)).toRotationMatrix();
  return r;
}

VecX any(unsigned seed) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> u(-1, 1);
  VecX b(3 * System::nodes);
  for (double& x : b) x = u(random);
  return b;
}

double worst_node(const VecX& x) {
  double w = 0;
  for (int i = 0; i < int(x.size()) / 3; ++i) w = std::max(w, x.segment<3>(3 * i).norm());
  return w;
}

int iterations(AsynchronousSolver& solver, const System& s) {
  const VecX b = any(9);
  VecX x = b;
  solver.solve(x.data());
  EXPECT_LT(worst_node(x - s.dense.ldlt().solve(b)), 10 * tolerance) << "what is left is judged with the old factor";
  return solver.status().iterations;
}

/// A solver that has the factor of a system.
struct Ready {
  System s;
  AsynchronousSolver solver{tolerance};
  explicit Ready(unsigned seed) : s(seed) {
    solver.analyse(s.a);
    EXPECT_TRUE(solver.factorise(s.a));
  }
};

TEST(AsynchronousSolver, SolvesToItsToleranceWithAnOldFactor) {
  Ready ready(1);
  auto& [s, solver] = ready;
  EXPECT_LE(iterations(solver, s), few) << "16 bits alone";
  s.fill(turned(0), 0.5);
  ASSERT_TRUE(solver.factorise(s.a));
  const int changed = iterations(solver, s);
  EXPECT_GT(changed, few);
  EXPECT_EQ(solver.status().age, 1);
}

TEST(AsynchronousSolver, AMatrixThatTurnsWithItsNodesCostsNothing) {
  for (const bool told : {false, true}) {
    Ready ready(2);
    auto& [s, solver] = ready;
    const auto r = turned(0.7);
    s.fill(r, 0);
    if (told) solver.set_rotations(r);
    ASSERT_TRUE(solver.factorise(s.a));
    if (told) {
      EXPECT_LE(iterations(solver, s), few);
    } else {
      VecX x = any(9);
      solver.solve(x.data());
      EXPECT_GT(solver.status().iterations, 8);
    }
  }
}

TEST(AsynchronousSolver, AFactorComesSoManyStepsAfterItWasAskedFor) {
  Ready ready(3);
  auto& [s, solver] = ready;
  s.fill(turned(0), 3);
  ASSERT_TRUE(solver.factorise(s.a));
  ASSERT_GT(iterations(solver, s), AsynchronousSolver::enough_iterations);
  for (int k = 0; k < solver.delay(); ++k) {
    ASSERT_EQ(solver.status().factors, 1) << k;
    ASSERT_TRUE(solver.factorise(s.a));
    iterations(solver, s);
  }
  ASSERT_TRUE(solver.factorise(s.a));
  EXPECT_EQ(solver.status().factors, 2);
  EXPECT_EQ(solver.status().age, solver.delay());
  EXPECT_LE(iterations(solver, s), few);
}

TEST(AsynchronousSolver, WithoutLeaveToWaitAStepGoesOnWithTheOldFactor) {
  Ready ready(4);
  auto& [s, solver] = ready;
  solver.set_timing(FactorTiming::when_ready);
  s.fill(turned(0), 3);
  // However long the thread takes, every step has a solution; and at last the factor comes.
  int steps = 0;
  for (; solver.status().factors < 2 && steps < 100000; ++steps) {
    ASSERT_TRUE(solver.factorise(s.a));
    VecX x = any(unsigned(steps));
    solver.solve(x.data());
    ASSERT_TRUE(x.allFinite());
  }
  EXPECT_EQ(solver.status().factors, 2);
}

TEST(AsynchronousSolver, AToldStepTakesTheFactorThenAndNotBefore) {
  Ready ready(4);
  auto& [s, solver] = ready;
  solver.set_timing(FactorTiming::told);
  s.fill(turned(0), 3);
  const int later = 3 * solver.delay() + 5;
  for (int k = 0; k < later; ++k) {
    ASSERT_TRUE(solver.factorise(s.a));
    iterations(solver, s);
    EXPECT_FALSE(solver.took());
  }
  EXPECT_EQ(solver.status().factors, 1);
  solver.take_next();
  ASSERT_TRUE(solver.factorise(s.a));
  EXPECT_TRUE(solver.took());
  EXPECT_EQ(solver.status().factors, 2);
  iterations(solver, s);
  ASSERT_TRUE(solver.factorise(s.a));
  EXPECT_FALSE(solver.took());
}

/// Rows of three nodes each, rows of another body between them.
struct ThreeNodeRows {
  static constexpr int m = 12;
  BodyRows rows;
  MatX h = MatX::Zero(m, 3 * System::nodes);
  std::vector<int> identity = std::vector<int>(System::nodes);
  /// Every third row is changed by this part of itself.
  explicit ThreeNodeRows(double change = 0) {
    for (int i = 0; i < System::nodes; ++i) identity[std::size_t(i)] = i;
    rows.clear();
    const VecX c = any(7);
    for (int i = 0; i < m; ++i) {
      rows.open(2 * i);
      for (int k = 0; k < 3; ++k) {
        const int node = (17 * i + 5 * k) % System::nodes;
        const Vec3 entry = (i % 3 == 0 ? 1 + change : 1.0) * c.segment<3>(3 * (i + k));
        rows.add(node, entry);
        h.block<1, 3>(i, 3 * node) += entry.transpose();
      }
    }
  }
};

/// What the solver says that lambda does.
VecX corrected(AsynchronousSolver& solver, const BodyRows& rows, const VecX& lambda) {
  const std::vector<double>& x = solver.correct(rows, lambda.data());
  return Eigen::Map<const VecX>(x.data(), long(x.size()));
}

TEST(AsynchronousSolver, RowsThatHardlyChangeAreKept) {
  for (const double change : {0.0, 0.015, 0.1}) {
    Ready ready(5);
    auto& [s, solver] = ready;
    const ThreeNodeRows first, then(change);
    solver.compute_compliance(first.rows, first.identity);
    EXPECT_EQ(solver.cost().rows_reused, 0);
    ASSERT_TRUE(solver.factorise(s.a));
    solver.compute_compliance(then.rows, then.identity);
    EXPECT_EQ(solver.cost().rows_reused, change < 0.02 ? then.m : then.m - 4);
    // Whatever is kept, lambda does what the rows of now say.
    VecX lambda(2 * then.m), own(then.m);
    for (int i = 0; i < then.m; ++i) own[i] = lambda[2 * i] = 1e-3 * std::cos(i);
    EXPECT_LT(worst_node(corrected(solver, then.rows, lambda) - s.dense.ldlt().solve(then.h.transpose() * own)),
              3 * tolerance)
        << change;
  }
}

TEST(AsynchronousSolver, CorrectionKnowsTheStepsOwnMatrix) {
  Ready ready(5);
  auto& [s, solver] = ready;
  const auto r = turned(0.3);
  s.fill(r, 0.3);
  solver.set_rotations(r);
  ASSERT_TRUE(solver.factorise(s.a));

  constexpr int m = ThreeNodeRows::m;
  const ThreeNodeRows all;
  const auto& [rows, h, identity] = all;
  solver.compute_compliance(rows, identity);
  MatX w = MatX::Zero(2 * m, 2 * m), near(m, m);
  solver.add_compliance(rows, w.data(), 2 * m);
  for (int i = 0; i < m; ++i)
    for (int j = 0; j < m; ++j) near(i, j) = w(2 * i, 2 * j);
  const MatX truth = h * s.dense.ldlt().solve(h.transpose());
  const double apart = (near - truth).norm() / truth.norm();
  EXPECT_LT(apart, 0.3);
  EXPECT_GT(apart, 1e-4) << "there is something to correct";

  VecX lambda = VecX::Zero(2 * m);
  for (const double scale : {1.0, 1.001, 0.2}) {
    VecX own = VecX::Zero(m);
    for (int i = 0; i < m; ++i) own[i] = lambda[2 * i] = 1e-3 * scale * std::cos(i + scale);
    const VecX x = corrected(solver, rows, lambda);
    EXPECT_TRUE(test::held("what lambda does, W an old one's",
                           worst_node(x - s.dense.ldlt().solve(h.transpose() * own)), 1, 3 * tolerance))
        << scale;
  }
}

// Steps of a body under rows whose forces change: free motion under the last forces, then what is new. Together they
// are the step's motion, and what the compliance takes off for the lagged forces leaves nearly the motion without any.
TEST(AsynchronousSolver, FreeMotionUnderLaggedForcesAndTheCorrectionAreTheWholeMotion) {
  Ready ready(7);
  auto& [s, solver] = ready;
  constexpr int m = ThreeNodeRows::m;
  const ThreeNodeRows all;
  const auto& [rows, h, identity] = all;
  const BodyRows none = [] {
    BodyRows r;
    r.clear();
    return r;
  }();
  VecX last = VecX::Zero(3 * System::nodes);
  for (int step = 0; step < 12; ++step) {
    const auto r = turned(0.02 * step);
    s.fill(r, 0.02 * step);
    solver.set_rotations(r);
    const VecX force = 1e-3 * any(20) * (1 + 0.05 * step);
    const auto truth = s.dense.ldlt();
    ASSERT_TRUE(solver.begin_motion(&s.a, force, last));
    VecX unforced = last;
    solver.unforced_motion(force, unforced);
    EXPECT_LT(worst_node(unforced - truth.solve(force)), 5 * solver.early * tolerance) << step;
    // Rows vanish for two steps: their last forces must go too.
    const bool touched = step % 6 < 4;
    VecX lambda = VecX::Zero(2 * m), own = VecX::Zero(m);
    if (touched)
      for (int i = 0; i < m; ++i) own[i] = lambda[2 * i] = 1e-3 * std::cos(i + 0.1 * step);
    solver.compute_compliance(touched ? rows : none, identity);
    if (touched) {
      MatX w = MatX::Zero(2 * m, 2 * m);
      solver.add_compliance(rows, w.data(), 2 * m);
      VecX delta = VecX::Zero(2 * m), free(m), at(m);
      solver.add_free_motion(rows, delta.data());
      for (int i = 0; i < m; ++i) free[i] = delta[2 * i];
      solver.subtract_lagged(rows, delta.data());
      for (int i = 0; i < m; ++i) at[i] = delta[2 * i];
      const VecX without = h * truth.solve(force), held = free - without;
      EXPECT_LT((at - without).norm(), 0.1 * (without.norm() + held.norm()) + 50 * tolerance) << step;
      if (step == 2) {
        EXPECT_GT(held.norm(), 100 * (at - without).norm() / 10) << "there is something to take off";
      }
    }
    solver.end_motion(touched ? rows : none, lambda.data(), last);
    EXPECT_LT(worst_node(last - truth.solve(force + h.transpose() * own)), 5 * tolerance) << step;
  }
}

TEST(AsynchronousSolver, ForgetsAndBeginsAnewWithTheSameBits) {
  System s(6);
  AsynchronousSolver solver(tolerance);
  solver.analyse(s.a);
  std::vector<double> bits[2];
  for (auto& out : bits) {
    solver.reset();
    s.fill(turned(0), 0);
    ASSERT_TRUE(solver.factorise(s.a));
    for (int k = 0; k < 30; ++k) {
      const auto r = turned(0.01 * k);
      s.fill(r, 0.05 * k);
      solver.set_rotations(r);
      ASSERT_TRUE(solver.factorise(s.a));
      VecX x = any(unsigned(k));
      solver.solve(x.data());
      out.insert(out.end(), x.data(), x.data() + x.size());
    }
    solver.set_rotations(turned(0));
  }
  EXPECT_EQ(bits[0], bits[1]);
  EXPECT_GT(solver.status().factors, 1);
}

}  // namespace
}  // namespace insula
