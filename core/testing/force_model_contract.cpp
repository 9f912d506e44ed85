// SPDX-License-Identifier: GPL-3.0-or-later
// Contract of force models: energy, force, stiffness and, of those that act within the body, invariance under rigid motion.
#include <gtest/gtest.h>

#include <Eigen/Eigenvalues>
#include <cmath>
#include <numeric>

#include "core/base/random.h"
#include "core/testing/contracts.h"
#include "core/testing/example.h"
#include "core/testing/held.h"

namespace insula::test {
namespace {

/// The model bound to a matrix of its own in which no node is held.
struct Bench {
  DeformableBody& body;
  ForceModel& model;
  BlockMatrix matrix;
  int n;

  Bench(DeformableBody& b, ForceModel& m) : body(b), model(m), n(3 * b.nodes()) {
    std::vector<std::pair<int, int>> pairs;
    model.couplings(pairs, Tangent::exact);
    model.couplings(pairs, Tangent::system);
    matrix.set_pattern(body.nodes(), std::move(pairs));
    std::vector<int> all(std::size_t(body.nodes()));
    std::iota(all.begin(), all.end(), 0);
    model.bind(matrix, all);
  }
  VecX force(const VecX& x) {
    VecX f = VecX::Zero(n);
    model.linearise(x.data(), f.data(), nullptr, 0, Tangent::system);
    return f;
  }
  MatX stiffness(const VecX& x, double h, Tangent which) {
    VecX f = VecX::Zero(n);
    matrix.set_zero();
    model.linearise(x.data(), f.data(), &matrix, h, which);
    return dense();
  }
  /// Of the force that depends on velocity; C if it is asked for.
  VecX damping_force(const VecX& x, const VecX& v, double h, MatX* damping = nullptr) {
    VecX f = VecX::Zero(n);
    matrix.set_zero();
    model.linearise_damping(x.data(), v.data(), f.data(), damping ? &matrix : nullptr, h);
    if (damping) *damping = dense();
    return f;
  }
  MatX dense() const {
    MatX k = MatX::Zero(n, n);
    for (int j = 0; j < matrix.nodes(); ++j) {
      const int end = j + 1 < matrix.nodes() ? matrix.column_start(j + 1) : matrix.slots();
      for (int s = matrix.column_start(j); s < end; ++s) {
        const Eigen::Map<const Mat3> block(matrix.block(s));
        k.block<3, 3>(3 * matrix.row(s), 3 * j) = block;
        if (matrix.row(s) != j) k.block<3, 3>(3 * j, 3 * matrix.row(s)) = block.transpose();
      }
    }
    return k;
  }
};

void expect_balanced(const Bench& b, const VecX& x, const VecX& f, double reference) {
  Vec3 sum = Vec3::Zero(), moment = Vec3::Zero(), centre = Vec3::Zero();
  double size = 0;
  const int nodes = b.body.nodes();
  for (int i = 0; i < nodes; ++i) centre += x.segment<3>(3 * i) / nodes;
  for (int i = 0; i < nodes; ++i) {
    const Vec3 r = x.segment<3>(3 * i) - centre, fi = f.segment<3>(3 * i);
    sum += fi;
    moment += r.cross(fi);
    size = std::max(size, r.norm());
  }
  EXPECT_TRUE(held("forces add up to nothing", sum.norm(), reference, 1e-10));
  EXPECT_TRUE(held("moments add up to nothing", moment.norm(), reference * size, 1e-10));
}

void check_state(Bench& b, const VecX& x, std::uint64_t seed) {
  Random random(seed);
  const double edge = shortest_edge(b.body);  // the scale of differences
  const VecX f = b.force(x);
  const double largest = f.lpNorm<Eigen::Infinity>();
  ASSERT_GT(largest, 0) << "the deformed state gives no force";
  if (b.model.internal()) expect_balanced(b, x, f, f.lpNorm<1>());

  // Fourth-order central differences of the energy at a sample of the degrees of freedom.
  for (int trial = 0; trial < 60; ++trial) {
    const int i = int(random.below(std::uint32_t(b.n)));
    const double e = 1e-3 * edge;
    const auto energy = [&](double d) {
      VecX y = x;
      y[i] += d;
      return b.model.energy(y.data());
    };
    const double slope = (8 * (energy(e) - energy(-e)) - (energy(2 * e) - energy(-2 * e))) / (12 * e);
    EXPECT_TRUE(held("force = minus energy gradient", std::abs(f[i] + slope), largest, 1e-7)) << "degree of freedom " << i;
  }

  // Stiffness against differences of the force, along random directions.
  const MatX exact = b.stiffness(x, 0, Tangent::exact);
  EXPECT_TRUE(held("exact stiffness is symmetric", (exact - exact.transpose()).norm(), exact.norm(), 1e-12));
  for (int trial = 0; trial < 10; ++trial) {
    VecX d(b.n);
    for (int i = 0; i < b.n; ++i) d[i] = random.uniform(-1, 1);
    const double e = 1e-3 * edge;
    const VecX slope = (8 * (b.force(x + e * d) - b.force(x - e * d)) - (b.force(x + 2 * e * d) - b.force(x - 2 * e * d))) / (12 * e);
    const VecX product = exact * d;
    EXPECT_TRUE(held("exact stiffness = force gradient", (product + slope).norm(), product.norm(), 1e-6));
  }

  const MatX system = b.stiffness(x, 0, Tangent::system);
  EXPECT_LT((system - system.transpose()).norm(), 1e-12 * system.norm());
  const VecX values = Eigen::SelfAdjointEigenSolver<MatX>(system, Eigen::EigenvaluesOnly).eigenvalues();
  EXPECT_GT(values[0], -1e-10 * values[b.n - 1]) << "the step's tangent has a negative eigenvalue";
  const double h = 0.01;
  EXPECT_LT((b.stiffness(x, h, Tangent::system) - (1 + b.model.stiffness_damping() / h) * system).norm(), 1e-12 * system.norm() * (1 + b.model.stiffness_damping() / h));
}

VecX random_vector(Random& random, int n, double scale) {
  VecX d(n);
  for (int i = 0; i < n; ++i) d[i] = scale * random.uniform(-1, 1);
  return d;
}

/// Damping of the model's own, in a state without a history.
void check_damping(Bench& b, const VecX& x, std::uint64_t seed) {
  constexpr double h = 0.01;
  Random random(seed);
  const double speed = 0.1 * shortest_edge(b.body) / h;
  const VecX v = random_vector(random, b.n, speed);
  MatX damping;
  const VecX f = b.damping_force(x, v, h, &damping);
  ASSERT_GT(f.norm(), 0) << "has_damping(), but velocity gives no force";
  EXPECT_TRUE(held("force with and without its damping matrix", (f - b.damping_force(x, v, h)).norm(), f.norm(), 1e-14));
  if (b.model.internal()) expect_balanced(b, x, f, f.lpNorm<1>());
  EXPECT_LT(f.dot(v), 0) << "the damping adds energy";
  EXPECT_TRUE(held("damping is symmetric", (damping - damping.transpose()).norm(), damping.norm(), 1e-12));
  for (int trial = 0; trial < 10; ++trial) {
    const VecX d = random_vector(random, b.n, 1);
    const double e = 1e-3 * speed;
    const VecX slope = (b.damping_force(x, v + e * d, h) - b.damping_force(x, v - e * d, h)) / (2 * e), product = damping * d;
    EXPECT_TRUE(held("damping = minus force gradient by velocity", (product + slope).norm(), product.norm(), 1e-6));
  }
  const VecX values = Eigen::SelfAdjointEigenSolver<MatX>(damping, Eigen::EigenvaluesOnly).eigenvalues();
  EXPECT_GT(values[0], -1e-10 * values[b.n - 1]) << "the damping has a negative eigenvalue";
}

}  // namespace

void check_force_model(const std::filesystem::path& scene, const std::string& element) {
  auto simulation = load(scene);
  ASSERT_TRUE(simulation);
  int found = 0;
  for (ForceModel* m : simulation->scene().all<ForceModel>()) {
    if (m->element != element) continue;
    auto* body = dynamic_cast<DeformableBody*>(m->parent);
    ASSERT_TRUE(body);
    ++found;
    Bench bench(*body, *m);
    const VecX rest = body->q();
    double reference = 0;
    for (std::uint64_t seed = 1; seed <= 3; ++seed) {
      SCOPED_TRACE("deformed state " + std::to_string(seed));
      const VecX x = deformed(*body, 0.1, seed);
      m->reset();
      reference = bench.force(x).lpNorm<Eigen::Infinity>();
      check_state(bench, x, seed);
      if (m->has_damping()) check_damping(bench, x, seed);
    }
    // Rigid motions, also far ones and without a warm start.
    Random random(5);
    for (int trial = 0; trial < 10; ++trial) {
      const Vec3 turn(random.uniform(-2, 2), random.uniform(-2, 2), random.uniform(-2, 2)), shift(random.uniform(-0.1, 0.1), 0.05, -0.02);
      const Quat q = from_rotation_vector(turn);
      VecX x(rest.size());
      for (int i = 0; i < body->nodes(); ++i) x.segment<3>(3 * i) = q * rest.segment<3>(3 * i) + shift;
      m->reset();
      if (m->internal()) { EXPECT_TRUE(held("rigid motion gives no force", bench.force(x).lpNorm<Eigen::Infinity>(), reference, 1e-10)); }
      EXPECT_GE(m->energy(x.data()), 0);
    }
    EXPECT_GE(m->stiffness_damping(), 0);
    // The same laws about another stress-free configuration.
    const VecX moved = 0.5 * (deformed(*body, 0.1, 4) - rest);
    const VecX before = bench.force(rest);
    if (!m->prestrain(moved.data())) continue;
    EXPECT_GT((bench.force(rest) - before).lpNorm<Eigen::Infinity>(), 1e-3 * reference) << "a prestrain gives no force at rest";
    for (std::uint64_t seed = 5; seed <= 6; ++seed) {
      SCOPED_TRACE("prestrained, deformed state " + std::to_string(seed));
      m->reset();
      check_state(bench, deformed(*body, 0.1, seed), seed);
    }
    const VecX back = -moved;
    m->prestrain(back.data());
    m->reset();
    EXPECT_LT((bench.force(rest) - before).lpNorm<Eigen::Infinity>(), 1e-10 * reference) << "prestrains do not add up";
  }
  EXPECT_GT(found, 0) << "its example holds no <" << element << ">";
}

}  // namespace insula::test
