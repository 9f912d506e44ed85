// SPDX-License-Identifier: GPL-3.0-or-later
// Modes of a block of tissue: all of them are the block, a few are its answer near a tool.
#include "core/haptics/reduced_basis.h"

#include <gtest/gtest.h>

#include <Eigen/Eigenvalues>
#include <cmath>

#include "core/constraint/problem_for_test.h"
#include "tests/physics/soft_body_for_test.h"

namespace insula::test {
namespace {

constexpr double h = 1.0 / 60, tick_s = 1e-3;
const Material brain{2100, 0.4, 1000, 2, 0.02};

MaterialPoint node(SoftBody& body, int i) {
  MaterialPoint p;
  p.body = &body;
  p.count = 1;
  p.node[0] = i;
  p.weight[0] = 1;
  return p;
}

/// Three rows for each of some nodes of a body, and the nodes as places of tools.
struct Sample {
  std::unique_ptr<SoftBody> body;
  BodyRows rows;
  std::vector<ReducedBasis::Loaded> loaded;
  int count() const { return rows.count(); }
  Sample(const std::array<int, 3>& cells, double size, const std::function<int(const Vec3&)>& tool_at)
      : body(soft_body(block_mesh(cells, Vec3::Zero(), Vec3::Constant(size)), brain,
                       [](const Vec3& x) { return x.z() < 1e-9; })) {
    rows.clear();
    for (int i = 0; i < body->nodes(); ++i) {
      const int tool = tool_at(body->rest_nodes()[std::size_t(i)]);
      if (tool < 0) continue;
      const MaterialPoint p = node(*body, i);
      loaded.push_back({p, count(), tool});
      for (int k = 0, first = count(); k < 3; ++k) {
        rows.open(first + k);
        body->add_row(rows, p, Vec3::Unit(k));
      }
    }
  }
  /// Steps the block, and gives the rows' compliance.
  MatX step(double length_s) {
    test::step(*body, length_s);
    return compliance();
  }
  MatX compliance() {
    ConstraintProblem p;
    p.resize(count());
    body->solver()->exchange_rows();
    body->begin_compliance(rows);
    body->solver()->compute_parts();
    body->solver()->add_compliance(rows, p.w.data(), p.stride);
    body->solver()->exchange_rows();
    return testing::w_of(p);
  }
};

ConstraintProblem problem_with(const MatX& w) {
  ConstraintProblem p;
  p.resize(int(w.rows()));
  testing::set_w(p, w);
  return p;
}

std::vector<double> diagonal(const MatX& w) {
  std::vector<double> out;
  for (long i = 0; i < w.rows(); ++i) out.push_back(w(i, i));
  return out;
}

/// Compliance of the rows by the modes over a time.
MatX by_modes(const ReducedModel& m, int rows, double dt) {
  MatX g(rows, m.size());
  VecX d(m.size());
  for (int s = 0; s < m.size(); ++s) {
    const ReducedModel::Mode& mode = m.modes[std::size_t(s)];
    d[s] = 1 / (mode.mass_s2 / (dt * dt) + mode.damping_s / dt + mode.stiffness(h));
    for (int i = 0; i < rows; ++i) g(i, s) = m.row(std::size_t(i))[s];
  }
  return g * d.asDiagonal() * g.transpose();
}

constexpr ReducedBasis::Size all{.loads_of_tool = 4, .levels = 3};

/// Eight free nodes, four of them for each tool: 24 values, and as many modes. It is so large that its inertia is about
/// its stiffness.
Sample small_block() {
  Sample block({1, 1, 2}, 80e-3, [](const Vec3& x) { return x.z() < 1e-9 ? -1 : x.z() > 60e-3 ? 0 : 1; });
  // Loaded without a symmetry, and so little that the block is linear.
  for (int i = 0; i < block.body->nodes(); ++i) block.body->external.segment<3>(3 * i) = Vec3(1e-7, 2e-7, -3e-7) * i;
  return block;
}

TEST(ReducedBasis, AllModesAreTheBody) {
  Sample block = small_block();
  for (int n = 0; n < 5; ++n) block.step(h);
  const MatX w = block.step(h);
  ReducedBasis basis(all);
  basis.compute(*block.body, *block.body->solver(), block.loaded, w.data(), int(w.rows()));
  basis.observe(*block.body);
  ConstraintProblem p = problem_with(w);
  basis.add(*block.body, block.rows, diagonal(w), p);
  ASSERT_EQ(p.reduced.size(), 24);
  EXPECT_LT((by_modes(p.reduced, p.rows, h) - w).norm(), 1e-6 * w.norm());
  const MatX w_tick = block.step(tick_s);
  EXPECT_LT((by_modes(p.reduced, p.rows, tick_s) - w_tick).norm(), 1e-6 * w_tick.norm());
}

TEST(ReducedBasis, TheEndOfAStepContinuesAsTheBodyDoes) {
  Sample block = small_block();
  // Let go of, so that velocity and acceleration are not small.
  for (int n = 0; n < 5; ++n) block.step(h);
  block.body->external.setZero();
  MatX w = block.step(h);
  ReducedBasis basis(all);
  basis.compute(*block.body, *block.body->solver(), block.loaded, w.data(), int(w.rows()));
  w = block.step(h);
  basis.observe(*block.body);
  ConstraintProblem p = problem_with(w);
  basis.add(*block.body, block.rows, diagonal(w), p);
  const VecX q = block.body->q();
  block.step(tick_s);
  double error = 0, moved = 0;
  for (std::size_t i = 0; i < block.loaded.size(); ++i)
    for (int k = 0; k < 3; ++k) {
      const int dof = 3 * block.loaded[i].point.node[0] + k;
      double by_modes = 0;
      for (std::size_t s = 0; s < p.reduced.modes.size(); ++s) {
        const ReducedModel::Mode& m = p.reduced.modes[s];
        const double d = 1 / (m.mass_s2 / (tick_s * tick_s) + m.damping_s / tick_s + m.stiffness(h));
        by_modes += p.reduced.row(3 * i + std::size_t(k))[s] * d * (m.force + m.mass_s2 / tick_s * m.velocity);
      }
      const double truth = block.body->q()[dof] - q[dof];
      error = std::max(error, std::abs(by_modes - truth));
      moved = std::max(moved, std::abs(truth));
    }
  EXPECT_GT(moved, 1e-9);
  EXPECT_LT(error, 1e-4 * moved);
}

TEST(ReducedBasis, AFewModesAnswerWhereAToolTouches) {
  // The top of a larger block, near its middle. Compliance in a tick to a uniform load: modes and residual, against
  // the same without inertia.
  Sample block({6, 6, 6}, 12e-3,
               [](const Vec3& x) { return x.z() > 11.9e-3 && (x - Vec3(6e-3, 6e-3, 12e-3)).norm() < 3.1e-3 ? 0 : -1; });
  const MatX w = block.step(h);
  ReducedBasis basis;
  basis.compute(*block.body, *block.body->solver(), block.loaded, w.data(), int(w.rows()));
  basis.observe(*block.body);
  ConstraintProblem p = problem_with(w);
  basis.add(*block.body, block.rows, diagonal(w), p);
  EXPECT_EQ(p.reduced.size(), ReducedBasis::Size{}.loads_of_tool * ReducedBasis::Size{}.levels);
  const MatX residual = w - by_modes(p.reduced, p.rows, h);
  EXPECT_GT(Eigen::SelfAdjointEigenSolver<MatX>(residual).eigenvalues().minCoeff(), -1e-9 * w.norm());
  const double share = tick_s / (brain.rayleigh_stiffness + tick_s) * (h + brain.rayleigh_stiffness) / h;
  const MatX with = by_modes(p.reduced, p.rows, tick_s) + share * residual, without = share * w;
  const MatX truth = block.step(tick_s);
  for (int k = 0; k < 3; ++k) {
    VecX load = VecX::Zero(p.rows);
    for (int i = k; i < p.rows; i += 3) load[i] = 1;
    const double whole = load.dot(truth * load);
    EXPECT_NEAR(load.dot(with * load), whole, 0.03 * whole) << k;
    EXPECT_GT(std::abs(load.dot(without * load) - whole), 0.1 * whole) << k;
  }
}

}  // namespace
}  // namespace insula::test
