// SPDX-License-Identifier: GPL-3.0-or-later
// The factor in 16 bits against the same numbers rounded by hand, with every instruction set, and against the factor it
// is of.
#include "core/linalg/fp16_factor.h"

#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <random>

#include "core/linalg/instruction_set.h"

namespace insula {
INSULA_TABLES(Fp16Kernels, fp16_table)
namespace {

float rounded(float x) {
  const _Float16 h = static_cast<_Float16>(std::clamp(x, -65504.f, 65504.f));
  return float(h);
}

TEST(Fp16Kernels, RoundAndSolveAsPlainLoopsDo) {
  const auto tables = every_fp16_table();
  std::mt19937 dice(5);
  std::uniform_real_distribution<float> any(-1, 1);
  for (const InstructionSet set : {InstructionSet::sse2, InstructionSet::avx2, InstructionSet::avx512}) {
    if (!processor_has(set)) continue;
    const Fp16Kernels& k = *tables.table[std::size_t(set)];
    for (const int own : {3, 6, 9, 21})
      for (const int below : {0, 3, 15, 18, 33, 60}) {
        SCOPED_TRACE(testing::Message() << "set " << int(set) << ", " << own << " + " << below << " rows");
        const int rows = own + below;
        Eigen::MatrixXf l = Eigen::MatrixXf::Zero(rows, own);
        std::vector<float> numbers;
        for (int first = 0; first < own;) {
          const int n = half_columns_from(first, own), last = first + n;
          std::vector<float> block(std::size_t(half_block_size(rows, first, n)), 0.f);
          std::size_t at = 0;
          for (int c = first; c < last; ++c)
            for (int r = c + 1; r < last; ++r) l(r, c) = block[at++] = 0.3f * any(dice);
          for (int c = first; c < last; ++c)
            for (int r = last; r < rows; ++r) {
              const int i = r - last;
              l(r, c) = block[std::size_t(half_lanes + (i / half_lanes) * half_lanes * n + (c - first) * half_lanes +
                                          i % half_lanes)] = 0.3f * any(dice);
            }
          numbers.insert(numbers.end(), block.begin(), block.end());
          first = last;
        }
        std::vector<Half> stream(numbers.size());
        k.to_half(stream.data(), numbers.data(), long(numbers.size()));
        Eigen::MatrixXd exact = l.unaryExpr(&rounded).cast<double>();

        std::vector<float> t(std::size_t(rows + 2 * half_lanes), 0.f);
        for (int r = 0; r < rows; ++r) t[std::size_t(r)] = any(dice);
        Eigen::VectorXd want = Eigen::Map<Eigen::VectorXf>(t.data(), rows).cast<double>();
        for (int c = 0; c < own; ++c)
          for (int r = c + 1; r < rows; ++r) want[r] -= exact(r, c) * want[c];
        EXPECT_EQ(k.forward(t.data(), stream.data(), own, rows), stream.data() + stream.size());
        for (int r = 0; r < rows; ++r)
          ASSERT_NEAR(t[std::size_t(r)], want[r], 2e-6 * (1 + want.cwiseAbs().maxCoeff())) << r;

        for (int r = 0; r < rows; ++r) t[std::size_t(r)] = any(dice);
        std::fill(t.begin() + rows, t.end(), 0.f);
        want = Eigen::Map<Eigen::VectorXf>(t.data(), rows).cast<double>();
        for (int c = own - 1; c >= 0; --c)
          for (int r = c + 1; r < rows; ++r) want[c] -= exact(r, c) * want[r];
        EXPECT_EQ(k.backward(t.data(), stream.data() + stream.size(), own, rows), stream.data());
        for (int r = 0; r < rows; ++r)
          ASSERT_NEAR(t[std::size_t(r)], want[r], 2e-6 * (1 + want.cwiseAbs().maxCoeff())) << r;
      }
    const std::vector<float> odd{0.f, -0.f, 1e30f, -1e30f, 65519.f, 1 + 0x1p-11f, 1 + 3 * 0x1p-12f, -0x1p-14f};
    std::vector<Half> bits(odd.size());
    k.to_half(bits.data(), odd.data(), long(odd.size()));
    EXPECT_EQ(bits, (std::vector<Half>{0, 0x8000, 0x7bff, 0xfbff, 0x7bff, 0x3c00, 0x3c01, 0x8400}));
  }
}

struct Lattice {
  static constexpr int side = 6, nodes = side * side * side;
  BlockMatrix a;
  Lattice() {
    std::vector<std::pair<int, int>> pairs;
    for (int i = 0; i < nodes; ++i)
      for (int step : {1, side, side * side})
        if (i / step % side + 1 < side) pairs.emplace_back(i, i + step);
    a.set_pattern(nodes, pairs);
    a.set_zero();
    std::mt19937 dice(3);
    std::uniform_real_distribution<double> stiffness(100, 1000);
    const auto block = [&](int i, int j) -> Eigen::Map<Mat3> {
      for (int s = a.column_start(j); s < a.column_start(j + 1); ++s)
        if (a.row(s) == i) return Eigen::Map<Mat3>(a.block(s));
      throw std::logic_error("no such block");
    };
    for (int i = 0; i < nodes; ++i) block(i, i) += 2 * Mat3::Identity();
    for (const auto& [i, j] : pairs) {
      const Mat3 k = Vec3(stiffness(dice), stiffness(dice), stiffness(dice)).asDiagonal();
      block(i, i) += k;
      block(j, j) += k;
      block(std::max(i, j), std::min(i, j)) -= k;
    }
  }
};

struct LatticeFactor : Lattice {
  MultifrontalCholesky<float> full;
  Fp16Factor fp16{analysed(full, a)};
  LatticeFactor() {
    EXPECT_TRUE(full.factorise(a));
    fp16.round();
  }
  static const MultifrontalCholesky<float>& analysed(MultifrontalCholesky<float>& factor, const BlockMatrix& a) {
    factor.analyse(a);
    return factor;
  }
};

TEST(Fp16Factor, SolvesAsItsFactorDoesButForRounding) {
  LatticeFactor s;
  Fp16Factor& fp16 = s.fp16;
  std::mt19937 dice(11);
  std::uniform_real_distribution<double> any(-1, 1);
  VecX b(3 * Lattice::nodes);
  for (double& x : b) x = any(dice);
  VecX exact = b, near = b;
  s.full.solve(exact.data());
  fp16.solve(near.data());
  const double error = (near - exact).norm() / exact.norm();
  EXPECT_LT(error, 0.02);
  EXPECT_GT(error, 1e-7) << "the same numbers: nothing was rounded";

  // What iterations with it leave: each makes the error so much smaller.
  VecX left = VecX::Zero(b.size());
  s.a.add_product(near.data(), left.data());
  left = b - left;
  fp16.solve(left.data());
  near += left;
  EXPECT_LT((near - exact).norm() / exact.norm(), 3e-4);

  BodyRows rows;
  rows.clear();
  std::vector<int> node_of_block(Lattice::nodes);
  for (int i = 0; i < Lattice::nodes; ++i) node_of_block[std::size_t(i)] = i;
  VecX lambda(4), force = VecX::Zero(b.size());
  for (int i = 0; i < 4; ++i) {
    rows.open(i);
    lambda[i] = any(dice);
    for (int node : {7 * i + 3, 50 * i + 20}) {
      const Vec3 d(any(dice), any(dice), any(dice));
      rows.add(node, d);
      force.segment<3>(3 * node) += lambda[i] * d;
    }
  }
  s.full.compute_compliance(rows, node_of_block);
  VecX corrected(b.size());
  fp16.correct(rows, lambda.data(), corrected.data());
  exact = force;
  s.full.solve(exact.data());
  EXPECT_LT((corrected - exact).norm() / exact.norm(), 0.02);
}

// The product of what is stored is positive definite, however coarse: energy of any load is positive.
TEST(Fp16Factor, IsPositiveDefinite) {
  LatticeFactor s;
  Fp16Factor& fp16 = s.fp16;
  std::mt19937 dice(17);
  std::normal_distribution<double> any;
  for (int k = 0; k < 50; ++k) {
    VecX b(3 * Lattice::nodes);
    for (double& x : b) x = any(dice);
    VecX x = b;
    fp16.solve(x.data());
    EXPECT_GT(x.dot(b), 0);
  }
}

}  // namespace
}  // namespace insula
