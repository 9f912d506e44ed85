// SPDX-License-Identifier: GPL-3.0-or-later
// Elements compressed below the barrier: energy in closed form, force and tangent as derivatives, and no inversion
// under load.
#include <gtest/gtest.h>

#include <Eigen/Eigenvalues>
#include <numeric>

#include "core/testing/example.h"
#include "tests/figures/figure.h"

namespace insula {
namespace {

const std::filesystem::path example = std::filesystem::path(INSULA_SOURCE_DIR) / "plugins/corotational_fem/example.xml";

struct CompressionBarrier : ::testing::Test {
  std::unique_ptr<Simulation> s;
  SoftBody* body = nullptr;
  ForceModel* model = nullptr;
  BlockMatrix matrix;
  void SetUp() override {
    s = test::load(example);
    ASSERT_TRUE(s);
    for (Body* b : s->bodies())
      if (!body) body = dynamic_cast<SoftBody*>(b);
    ASSERT_TRUE(body && !body->forces().empty());
    model = body->forces()[0];
    std::vector<std::pair<int, int>> pairs;
    model->couplings(pairs, Tangent::exact);
    matrix.set_pattern(body->nodes(), std::move(pairs));
    std::vector<int> all(std::size_t(body->nodes()));
    std::iota(all.begin(), all.end(), 0);
    model->bind(matrix, all);
  }
  /// The rest shape with z scaled, and the first nodes shaken so that every element is different.
  VecX squeezed(double z, double noise) {
    const VecX rest = body->q();
    VecX x = test::deformed(*body, noise, 5);
    for (int i = 0; i < body->nodes(); ++i) x[3 * i + 2] += (z - 1) * rest[3 * i + 2];
    return x;
  }
  VecX force(const VecX& x) {
    VecX f = VecX::Zero(x.size());
    model->linearise(x.data(), f.data(), nullptr, 0, Tangent::exact);
    return f;
  }
  VecX product(const VecX& x, const VecX& d, Tangent which) {
    VecX f = VecX::Zero(x.size()), out = VecX::Zero(x.size());
    matrix.set_zero();
    model->linearise(x.data(), f.data(), &matrix, 0, which);
    for (int j = 0; j < matrix.nodes(); ++j) {
      const int end = j + 1 < matrix.nodes() ? matrix.column_start(j + 1) : matrix.slots();
      for (int k = matrix.column_start(j); k < end; ++k) {
        const Mat3 m = Eigen::Map<const Mat3>(matrix.block(k));
        const int i = matrix.row(k);
        out.segment<3>(3 * i) += m * d.segment<3>(3 * j);
        if (i != j) out.segment<3>(3 * j) += m.transpose() * d.segment<3>(3 * i);
      }
    }
    return out;
  }
  VecX direction(int seed) {
    VecX d(3 * body->nodes());
    for (int i = 0; i < d.size(); ++i) d[i] = std::sin(1.7 * i + seed);
    return d / d.norm();
  }
};

TEST_F(CompressionBarrier, EnergyOfAUniformSqueeze) {
  // E 2100 Pa and nu 0.45 are the defaults of the element.
  const double young = 2100, nu = 0.45, mu = young / (2 * (1 + nu)), lambda = young * nu / ((1 + nu) * (1 - 2 * nu));
  const VecX rest = body->q();
  double volume = 0;
  for (const auto& t : body->rest().tets) {
    Mat3 d;
    for (int k = 0; k < 3; ++k)
      d.col(k) = body->rest().nodes[std::size_t(t[std::size_t(k + 1)])] - body->rest().nodes[std::size_t(t[0])];
    volume += d.determinant() / 6;
  }
  const auto energy = [&](double z) {
    const double e = z - 1, short_of = std::max(0.0, 0.4 - z);
    return volume * (mu * e * e + 0.5 * lambda * e * e + 0.5 * 30 * young * short_of * short_of);
  };
  test::Figure figure("squeeze", "Tissue squeezed flat, which stiffens below 0.4 of its height",
                      "height over that at rest", "energy, mJ");
  for (double z = 1; z > 0.04; z -= 0.01) figure.law("law", z, energy(z) * 1e3);
  for (const double z : {0.7, 0.41, 0.39, 0.2, 0.05}) {
    VecX x = rest;
    for (int i = 0; i < body->nodes(); ++i) x[3 * i + 2] *= z;
    EXPECT_NEAR(model->energy(x.data()), energy(z), 1e-9 * energy(z)) << z;
    figure.run("run", z, model->energy(x.data()) * 1e3);
  }
}

TEST_F(CompressionBarrier, ForceIsTheEnergysGradientAndTheTangentTheForces) {
  for (const double z : {0.3, 0.15, 0.05}) {
    const VecX x = squeezed(z, 0.1);
    const VecX f = force(x);
    for (int k = 0; k < 4; ++k) {
      const VecX d = direction(k);
      const double step = 1e-7;
      const VecX up = x + step * d, down = x - step * d;
      const double slope = (model->energy(up.data()) - model->energy(down.data())) / (2 * step);
      EXPECT_NEAR(-f.dot(d), slope, 1e-5 * f.norm()) << z;
      const VecX change = (force(down) - force(up)) / (2 * step), predicted = product(x, d, Tangent::exact);
      EXPECT_LT((change - predicted).norm(), 2e-4 * change.norm()) << z;
    }
  }
}

TEST_F(CompressionBarrier, TheStepsTangentIsPositive) {
  const VecX x = squeezed(0.1, 0.2);
  for (int k = 0; k < 20; ++k) {
    const VecX d = direction(k);
    EXPECT_GT(d.dot(product(x, d, Tangent::system)), 0) << k;
  }
}

}  // namespace
}  // namespace insula
