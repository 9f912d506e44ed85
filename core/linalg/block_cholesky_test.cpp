// SPDX-License-Identifier: GPL-3.0-or-later
// The direct solver against dense algebra, in double and single precision.
#include "core/linalg/block_cholesky.h"
#include "core/linalg/direct_solver.h"

#include <gtest/gtest.h>

#include <Eigen/Cholesky>
#include <limits>
#include <random>

namespace insula {
namespace {

struct Problem {
  BlockMatrix a;
  MatX dense;
  std::vector<int> identity;
  BodyRows rows;
  MatX h;
};

// A box of nodes with random symmetric couplings to its grid neighbours, diagonally dominant; `m` sparse rows.
Problem make(int nx, int ny, int nz, int m, unsigned seed) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> u(-1, 1);
  Problem p;
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
template <class Real>
class Direct : public testing::Test {
 protected:
  static constexpr double tolerance = sizeof(Real) == 8 ? 1e-13 : 2e-5;
};
using Precisions = testing::Types<double, float>;
TYPED_TEST_SUITE(Direct, Precisions);

TYPED_TEST(Direct, SolvesAsDenseAlgebraDoes) {
  for (unsigned seed = 1; seed < 6; ++seed) {
    Problem p = make(int(seed) + 1, 4, 5, 0, seed);
    MultifrontalCholesky<TypeParam> c;
    c.analyse(p.a);
    ASSERT_TRUE(c.factorise(p.a));
    VecX b = VecX::LinSpaced(p.dense.rows(), -1, 2), x = b;
    c.solve(x.data());
    EXPECT_LT((p.dense * x - b).template lpNorm<Eigen::Infinity>(), this->tolerance);
    VecX y = VecX::Zero(b.size());
    p.a.add_product(x.data(), y.data());
    EXPECT_LT((y - b).template lpNorm<Eigen::Infinity>(), this->tolerance);
  }
}

TYPED_TEST(Direct, ComplianceAndCorrection) {
  for (int m : {1, 3, 8, 37, 90}) {
    Problem p = make(6, 5, 5, m, unsigned(m));
    MultifrontalCholesky<TypeParam> c;
    c.analyse(p.a);
    ASSERT_TRUE(c.factorise(p.a));
    const int stride = (m + 7) & ~7;
    std::vector<double> w(std::size_t(m) * std::size_t(stride), 0.0);
    c.compute_compliance(p.rows, p.identity);
    c.add_compliance(p.rows, w.data(), stride);
    const MatX expected = p.h * p.dense.ldlt().solve(MatX(p.h.transpose()));
    for (int i = 0; i < m; ++i)
      for (int j = 0; j < m; ++j) EXPECT_NEAR(w[std::size_t(i * stride + j)], expected(i, j), this->tolerance);
    VecX lambda = VecX::LinSpaced(m, 1, 2), x(p.dense.rows());
    c.correct(p.rows, lambda.data(), x.data());
    EXPECT_LT((x - p.dense.ldlt().solve(p.h.transpose() * lambda)).template lpNorm<Eigen::Infinity>(), this->tolerance);
  }
}

TYPED_TEST(Direct, SaysWhenTheMatrixIsIndefinite) {
  Problem p = make(3, 3, 3, 0, 1);
  Eigen::Map<Mat3>(p.a.block(p.a.diagonal(13))) *= -1;
  MultifrontalCholesky<TypeParam> c;
  c.analyse(p.a);
  EXPECT_FALSE(c.factorise(p.a));
  Eigen::Map<Mat3>(p.a.block(p.a.diagonal(13))) *= -1;
  ASSERT_TRUE(c.factorise(p.a));
  const VecX b = VecX::LinSpaced(p.dense.rows(), -1, 2);
  VecX x = b;
  c.solve(x.data());
  EXPECT_LT((p.dense * x - b).template lpNorm<Eigen::Infinity>(), this->tolerance);
}

// Two nodes tied to each other and to nothing else, by a spring so stiff that their inertia is lost in its rounding; no number, too
// large a number. None may pass as a factor.
TYPED_TEST(Direct, SaysWhenAPivotIsLost) {
  BlockMatrix a;
  a.set_pattern(2, {{0, 1}});
  const auto spring = [&](double k, double inertia) {
    a.set_zero();
    for (int i = 0; i < 3; ++i) {
      a.block(a.slot(1, 0))[4 * i] = -k;
      for (int n = 0; n < 2; ++n) a.block(a.diagonal(n))[4 * i] = k + inertia;
    }
  };
  MultifrontalCholesky<TypeParam> c;
  c.analyse(a);
  const double eps = double(std::numeric_limits<TypeParam>::epsilon());
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

// The lesser precision costs what its rounding says, not more: W in float against W in double.
TEST(DirectSolver, SinglePrecisionIsAsGoodAsItsRounding) {
  Problem p = make(8, 8, 6, 60, 3);
  std::vector<double> w[2];
  for (int single = 0; single < 2; ++single) {
    const auto solver = make_direct_solver(single);
    solver->analyse(p.a);
    ASSERT_TRUE(solver->factorise(p.a));
    w[single].assign(60 * 64, 0.0);
    solver->compute_compliance(p.rows, p.identity);
    solver->add_compliance(p.rows, w[single].data(), 64);
  }
  double largest = 0, error = 0;
  for (std::size_t i = 0; i < w[0].size(); ++i) {
    largest = std::max(largest, std::abs(w[0][i]));
    error = std::max(error, std::abs(w[0][i] - w[1][i]));
  }
  EXPECT_LT(error, 2e-6 * largest);
  EXPECT_GT(error, 1e-9 * largest);
}

TYPED_TEST(Direct, SameBitsTwice) {
  Problem p = make(5, 5, 5, 20, 7);
  std::vector<double> first;
  for (int run = 0; run < 2; ++run) {
    MultifrontalCholesky<TypeParam> c;
    c.analyse(p.a);
    ASSERT_TRUE(c.factorise(p.a));
    std::vector<double> w(20 * 24, 0.0);
    c.compute_compliance(p.rows, p.identity);
    c.add_compliance(p.rows, w.data(), 24);
    if (run == 0) first = w;
    else EXPECT_EQ(first, w);
  }
}

}  // namespace
}  // namespace insula
