// SPDX-License-Identifier: GPL-3.0-or-later
// What every exact BodySolver must do, held against dense algebra. A solver's test names it by a type with
//   static std::unique_ptr<BodySolver> make()   null: it cannot be had on this machine, and the tests are skipped
//   tolerance          of results of the size of one
//   epsilon            of its numbers
//   is_double          their precision
//   keeps_single_rows  whether a row that stays is not solved again when others change
#pragma once
#include <gtest/gtest.h>

#include <Eigen/Cholesky>
#include <limits>
#include <memory>
#include <random>

#include "core/linalg/body_solver.h"
#include "core/testing/held.h"

namespace insula::test {

struct SolverProblem {
  BlockMatrix a;
  MatX dense;
  std::vector<int> identity;
  BodyRows rows;
  MatX h;
};

// A box of nodes with random symmetric couplings to its grid neighbours, diagonally dominant; `m` sparse rows.
inline SolverProblem make_problem(int nx, int ny, int nz, int m, unsigned seed) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> u(-1, 1);
  SolverProblem p;
  const int n = nx * ny * nz;
  auto at = [&](int x, int y, int z) { return (z * ny + y) * nx + x; };
  std::vector<std::pair<int, int>> pairs;
  for (int z = 0; z < nz; ++z)
    for (int y = 0; y < ny; ++y)
      for (int x = 0; x < nx; ++x)
        for (int d = 1; d < 8; ++d) {
          const int x2 = x + (d & 1), y2 = y + ((d >> 1) & 1), z2 = z + (d >> 2);
          if (x2 < nx && y2 < ny && z2 < nz) pairs.emplace_back(at(x, y, z), at(x2, y2, z2));
        }
  p.a.set_pattern(n, pairs);
  p.dense = MatX::Zero(3 * n, 3 * n);
  for (int j = 0; j < n; ++j)
    for (int s = p.a.column_start(j); s < p.a.column_start(j + 1); ++s) {
      const int i = p.a.row(s);
      Mat3 b;
      for (int k = 0; k < 9; ++k) b(k % 3, k / 3) = u(random);
      if (i == j) b = (b + b.transpose()).eval() + 40 * Mat3::Identity();
      Eigen::Map<Mat3>(p.a.block(s)) = b;
      p.dense.block<3, 3>(3 * i, 3 * j) = b;
      p.dense.block<3, 3>(3 * j, 3 * i) = b.transpose();
    }
  p.identity.resize(std::size_t(n));
  for (int i = 0; i < n; ++i) p.identity[std::size_t(i)] = i;
  p.h = MatX::Zero(m, 3 * n);
  p.rows.clear();
  for (int r = 0; r < m; ++r) {
    p.rows.open(r);
    for (int e = 0; e < 1 + r % 5; ++e) {
      const int node = int(random() % unsigned(n));
      const Vec3 c(u(random), u(random), u(random));
      p.rows.add(node, c);
      p.h.block<1, 3>(r, 3 * node) += c.transpose();
    }
  }
  return p;
}

// Numbers here are of the size of one, and A is diagonally dominant: errors are a few units in the last place.
template <class Made>
class BodySolverContract : public ::testing::Test {
 protected:
  void SetUp() override {
    solver = Made::make();
    if (!solver) GTEST_SKIP() << "this solver cannot be had on this machine";
  }
  static std::unique_ptr<BodySolver> make() { return Made::make(); }
  std::unique_ptr<BodySolver> solver;
};
TYPED_TEST_SUITE_P(BodySolverContract);

TYPED_TEST_P(BodySolverContract, SolvesAsDenseAlgebraDoes) {
  for (unsigned seed = 1; seed < 6; ++seed) {
    SolverProblem p = make_problem(int(seed) + 1, 4, 5, 0, seed);
    BodySolver& c = *this->solver;
    c.analyse(p.a);
    ASSERT_TRUE(c.factorise(p.a));
    VecX b = VecX::LinSpaced(p.dense.rows(), -1, 2), x = b;
    c.solve(x.data());
    EXPECT_LT((p.dense * x - b).template lpNorm<Eigen::Infinity>(), TypeParam::tolerance);
    VecX y = VecX::Zero(b.size());
    p.a.add_product(x.data(), y.data());
    EXPECT_TRUE(test::held(TypeParam::is_double ? "A x = b" : "A x = b, single precision",
                           (y - b).template lpNorm<Eigen::Infinity>(), 1, TypeParam::tolerance));
  }
}

TYPED_TEST_P(BodySolverContract, ComplianceAndCorrection) {
  for (int m : {1, 3, 8, 37, 90}) {
    SolverProblem p = make_problem(6, 5, 5, m, unsigned(m));
    BodySolver& c = *this->solver;
    c.analyse(p.a);
    ASSERT_TRUE(c.factorise(p.a));
    const int stride = (m + 7) & ~7;
    std::vector<double> w(std::size_t(m) * std::size_t(stride), 0.0);
    c.compute_compliance(p.rows, p.identity);
    c.add_compliance(p.rows, w.data(), stride);
    const MatX expected = p.h * p.dense.ldlt().solve(MatX(p.h.transpose()));
    for (int i = 0; i < m; ++i)
      for (int j = 0; j < m; ++j)
        EXPECT_TRUE(test::held(TypeParam::is_double ? "H A^-1 H^T" : "H A^-1 H^T, single precision",
                               std::abs(w[std::size_t(i * stride + j)] - expected(i, j)), 1, TypeParam::tolerance));
    VecX lambda = VecX::LinSpaced(m, 1, 2), x(p.dense.rows());
    const VecX none = VecX::Zero(p.dense.rows());
    ASSERT_TRUE(c.begin_motion(nullptr, none, none));
    c.end_motion(p.rows, lambda.data(), x);
    EXPECT_LT((x - p.dense.ldlt().solve(p.h.transpose() * lambda)).template lpNorm<Eigen::Infinity>(),
              TypeParam::tolerance);
  }
}

TYPED_TEST_P(BodySolverContract, SaysWhenTheMatrixIsIndefinite) {
  SolverProblem p = make_problem(3, 3, 3, 0, 1);
  Eigen::Map<Mat3>(p.a.block(p.a.diagonal(13))) *= -1;
  BodySolver& c = *this->solver;
  c.analyse(p.a);
  EXPECT_FALSE(c.factorise(p.a));
  Eigen::Map<Mat3>(p.a.block(p.a.diagonal(13))) *= -1;
  ASSERT_TRUE(c.factorise(p.a));
  const VecX b = VecX::LinSpaced(p.dense.rows(), -1, 2);
  VecX x = b;
  c.solve(x.data());
  EXPECT_LT((p.dense * x - b).template lpNorm<Eigen::Infinity>(), TypeParam::tolerance);
}

// Two nodes tied to each other and to nothing else, by a spring so stiff that their inertia is lost in its rounding; no
// number, too large a number. None may pass as a factor.
TYPED_TEST_P(BodySolverContract, SaysWhenAPivotIsLost) {
  BlockMatrix a;
  a.set_pattern(2, {{0, 1}});
  const auto spring = [&](double k, double inertia) {
    a.set_zero();
    for (int i = 0; i < 3; ++i) {
      a.block(a.slot(1, 0))[4 * i] = -k;
      for (int n = 0; n < 2; ++n) a.block(a.diagonal(n))[4 * i] = k + inertia;
    }
  };
  BodySolver& c = *this->solver;
  c.analyse(a);
  const double eps = TypeParam::epsilon;
  spring(1e3, 1e3 * 1e3 * eps);
  EXPECT_TRUE(c.factorise(a));
  spring(1e3, 1e3 * eps);
  EXPECT_FALSE(c.factorise(a));
  for (double bad : {0.0, -1.0, std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::infinity()}) {
    spring(1, 1);
    a.block(a.diagonal(1))[4] = bad;
    EXPECT_FALSE(c.factorise(a)) << bad;
  }
  spring(1, 1);
  EXPECT_TRUE(c.factorise(a));
}

/// Adds some rows of `from` to `to`.
inline void choose(const BodyRows& from, const std::vector<int>& rows, BodyRows& to) {
  for (int r : rows) {
    to.open(to.count());
    for (int e = from.start[std::size_t(r)]; e < from.start[std::size_t(r) + 1]; ++e)
      to.add(from.block[std::size_t(e)], from.coeff[std::size_t(e)]);
  }
}

/// H of the rows, whose blocks are nodes of the matrix.
inline MatX dense_rows(const BodyRows& rows, long unknowns) {
  MatX h = MatX::Zero(rows.count(), unknowns);
  for (int r = 0; r < rows.count(); ++r)
    for (int e = rows.start[std::size_t(r)]; e < rows.start[std::size_t(r) + 1]; ++e)
      h.block<1, 3>(r, 3 * rows.block[std::size_t(e)]) += rows.coeff[std::size_t(e)].transpose();
  return h;
}

/// What must hold of the two halves of a motion under this load and these rows.
template <class Made>
void expect_motion(BodySolver& solver, const SolverProblem& p, const BodyRows& rows, const VecX& load,
                   const VecX& lambda, double tolerance) {
  const int m = rows.count();
  const MatX h = dense_rows(rows, p.dense.rows());
  const auto dense = p.dense.ldlt();
  const VecX free = dense.solve(load), moved = dense.solve(load + h.transpose() * lambda.head(m));
  VecX delta = VecX::Constant(80, 2.0), motion;
  solver.unforced_motion(load, motion);
  EXPECT_LT((motion - free).template lpNorm<Eigen::Infinity>(), tolerance);
  solver.add_free_motion(rows, delta.data());
  if (m > 0) {
    EXPECT_TRUE(test::held(Made::is_double ? "H A^-1 f" : "H A^-1 f, single precision",
                           (delta.head(m) - h * free - VecX::Constant(m, 2.0)).template lpNorm<Eigen::Infinity>(), 1,
                           tolerance));
  }
  solver.end_motion(rows, lambda.data(), motion);
  EXPECT_TRUE(test::held(Made::is_double ? "A^-1 (f + H^T l)" : "A^-1 (f + H^T l), single precision",
                         (motion - moved).template lpNorm<Eigen::Infinity>(), 1, tolerance));
}

// Rows come, stay, change their place, change their entries and go while the factor stays, then the factor is made
// anew: W is to the bit what a solver gives that sees these rows for the first time. The load is another in every step,
// and both halves of the motion are those of dense algebra.
TYPED_TEST_P(BodySolverContract, RowsThatStayAreNotSolvedAgain) {
  SolverProblem p = make_problem(6, 6, 5, 70, 11), other = make_problem(6, 6, 5, 70, 12);
  std::vector<int> none, all, odd, turned, most;
  for (int r = 0; r < 70; ++r) {
    all.push_back(r);
    turned.push_back(69 - r);
    if (r % 2) odd.push_back(r);
    if (r % 9) most.push_back(r);
  }
  struct Act {
    std::vector<int> kept, fresh;  ///< of p, of other
    int reused;
  };
  const std::vector<Act> acts = {{all, none, 0},    {all, none, 70}, {turned, none, 70}, {odd, {}, 35},
                                 {odd, {5}, 35},    {odd, odd, 36},  {most, {3, 9}, 33}, {none, {4}, 0},
                                 {none, {4, 4}, 2}, {none, none, 0}, {odd, {3}, 0},      {odd, {3}, 36}};
  BodySolver& c = *this->solver;
  c.analyse(p.a);
  for (int factor = 0; factor < 2; ++factor) {
    p.a.block(p.a.diagonal(17))[0] += factor;
    ASSERT_TRUE(c.factorise(p.a));
    for (const Act& act : acts) {
      BodyRows rows;
      rows.clear();
      choose(p.rows, act.kept, rows);
      choose(other.rows, act.fresh, rows);
      const int m = rows.count(), stride = 80;
      std::vector<double> w(80 * 80, 0.0), expected(w);
      const VecX load = VecX::LinSpaced(p.dense.rows(), -1, m + 1), guess = VecX::Zero(load.size());
      ASSERT_TRUE(c.begin_motion(nullptr, load, guess));
      c.compute_compliance(rows, p.identity);
      c.add_compliance(rows, w.data(), stride);
      if (TypeParam::keeps_single_rows) {
        EXPECT_EQ(c.cost().rows_reused, act.reused);
      }
      const auto fresh_solver = this->make();
      BodySolver& fresh = *fresh_solver;
      fresh.analyse(p.a);
      ASSERT_TRUE(fresh.begin_motion(&p.a, load, guess));
      fresh.compute_compliance(rows, p.identity);
      fresh.add_compliance(rows, expected.data(), stride);
      EXPECT_EQ(fresh.cost().rows_reused, 0);
      EXPECT_EQ(w, expected) << m << " rows";
      const VecX lambda = VecX::LinSpaced(std::max(m, 1), 1, 2);

      for (BodySolver* each : {&c, &fresh})
        expect_motion<TypeParam>(*each, p, rows, load, lambda, 4 * TypeParam::tolerance);
    }
    p.dense(3 * 17, 3 * 17) += 1;
  }
}

// A chain so long that what its ends know of each other is below the smallest normal number in single precision. That
// is no reason to be slow (see FlushSubnormals), nor to be wrong, and the caller's rounding mode stays as it was.
TYPED_TEST_P(BodySolverContract, WhatIsFarApartMayVanish) {
  const int n = 60;
  std::vector<std::pair<int, int>> pairs;
  for (int i = 0; i + 1 < n; ++i) pairs.emplace_back(i, i + 1);
  BlockMatrix a;
  a.set_pattern(n, pairs);
  for (int i = 0; i < n; ++i)
    for (int k = 0; k < 3; ++k) {
      a.block(a.diagonal(i))[4 * k] = 10;
      if (i + 1 < n) a.block(a.slot(i + 1, i))[4 * k] = -1;
    }
  BodySolver& c = *this->solver;
  c.analyse(a);
  ASSERT_TRUE(c.factorise(a));
  VecX x = VecX::Zero(3 * n);
  x[0] = 1;
  c.solve(x.data());
  const double ratio = 5 - std::sqrt(24.0);  // of an endless chain, node to node
  EXPECT_NEAR(x[0], ratio, 4 * TypeParam::epsilon);
  EXPECT_NEAR(x[3 * (n - 1)] / std::pow(ratio, n), TypeParam::is_double ? 1 : 0, 0.02);
  volatile double smallest = std::numeric_limits<double>::min();
  EXPECT_GT(smallest / 2, 0);
}

TYPED_TEST_P(BodySolverContract, SameBitsTwice) {
  SolverProblem p = make_problem(5, 5, 5, 20, 7);
  std::vector<double> first;
  for (int run = 0; run < 2; ++run) {
    const auto again = this->make();
    BodySolver& c = *again;
    c.analyse(p.a);
    ASSERT_TRUE(c.factorise(p.a));
    std::vector<double> w(20 * 24, 0.0);
    c.compute_compliance(p.rows, p.identity);
    c.add_compliance(p.rows, w.data(), 24);
    if (run == 0) first = w;
    else EXPECT_EQ(first, w);
  }
}

REGISTER_TYPED_TEST_SUITE_P(BodySolverContract, SolvesAsDenseAlgebraDoes, ComplianceAndCorrection,
                            SaysWhenTheMatrixIsIndefinite, SaysWhenAPivotIsLost, RowsThatStayAreNotSolvedAgain,
                            WhatIsFarApartMayVanish, SameBitsTwice);

}  // namespace insula::test
