// SPDX-License-Identifier: GPL-3.0-or-later
// A condensed problem has the dynamics of the full one: eliminated rows are springs of the tissue.
#include "core/haptics/condense_modes.h"

#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <random>

#include "core/constraint/problem_for_test.h"
#include "core/constraint/solve.h"
#include "core/haptics/condense.h"

namespace insula {
namespace {

/// A body of some masses and springs. A tool touches the first rows; the others are springs to the ground.
struct SpringBody {
  static constexpr int dofs = 10, rows = 20, at_tool = 6;
  MatX mass = MatX::Zero(dofs, dofs), k, jacobian = MatX(rows, dofs);
  double compliance = 5e-3, h = 1.0 / 60;

  SpringBody() {
    std::mt19937 random(4);
    std::uniform_real_distribution<double> u(-1, 1);
    const MatX a = MatX::NullaryExpr(dofs, dofs, [&] { return u(random); });
    k = 30 * (a * a.transpose()) + 20 * MatX::Identity(dofs, dofs);
    for (int i = 0; i < dofs; ++i) mass(i, i) = 5e-3 * (1.2 + u(random));
    for (double& x : jacobian.reshaped()) x = u(random);
  }
  MatX system(double dt) const { return mass / (dt * dt) + k; }
  MatX kept_rows() const { return jacobian.topRows(at_tool); }
  MatX springs() const { return jacobian.bottomRows(rows - at_tool); }

  ConstraintProblem problem() const {
    ConstraintProblem p;
    p.resize(rows);
    p.step_s = h;
    testing::set_w(p, MatX(jacobian * system(h).ldlt().solve(jacobian.transpose())));
    for (int i = 0; i < rows; ++i) {
      Block b;
      b.id = std::uint64_t(10 + i);
      b.row = i;
      if (i < at_tool) b.lower = 0;
      else b.compliance = compliance;
      p.blocks.push_back(b);
      p.delta_free[std::size_t(i)] = -1e-3 * (1 + i % 3);
    }
    ToolTerms tool;
    tool.jacobian.setZero(rows, 6);
    for (int i = 0; i < at_tool; ++i) tool.jacobian.row(i).setConstant(1.0 + i);
    p.tools.push_back(tool);
    SolveWorkspace ws;
    ws.lambda.assign(std::size_t(rows), 0.0);
    solve(p, p.delta_free, {5000, 1e-15}, ws);
    p.lambda = ws.lambda;
    const Eigen::GeneralizedSelfAdjointEigenSolver<MatX> modes(mass, system(h));
    std::vector<ReducedModel::Mode> all;
    for (int s = 0; s < dofs; ++s) all.push_back({modes.eigenvalues()[s], 0, 0.1 * s, 1.0 - s});
    p.reduced.add_group(all, rows);
    const MatX g = jacobian * modes.eigenvectors();
    for (int i = 0; i < rows; ++i)
      for (int s = 0; s < dofs; ++s) p.reduced.row(std::size_t(i))[s] = g(i, s);
    return p;
  }
};

MatX participation(const ReducedModel& m, int rows) {
  MatX g(rows, m.size());
  for (int i = 0; i < rows; ++i)
    for (int s = 0; s < m.size(); ++s) g(i, s) = m.row(std::size_t(i))[s];
  return g;
}

TEST(CondenseModes, AllModesAreTheBodyWithItsSprings) {
  const SpringBody body;
  const ConstraintProblem full = body.problem();
  ConstraintProblem small;
  Condenser()(full, SpringBody::at_tool, small);
  ASSERT_EQ(small.rows, SpringBody::at_tool);
  ASSERT_EQ(small.reduced.size(), SpringBody::dofs);
  const MatX g = participation(small.reduced, small.rows), h_e = body.springs();
  for (const double dt : {body.h, 5e-3, 1e-3}) {
    VecX d(SpringBody::dofs);
    for (int s = 0; s < SpringBody::dofs; ++s) {
      const ReducedModel::Mode& m = small.reduced.modes[std::size_t(s)];
      d[s] = 1 / (m.mass_s2 / (dt * dt) + m.stiffness(body.h));
    }
    const MatX a = body.system(dt) + h_e.transpose() * h_e / body.compliance;
    const MatX truth = body.kept_rows() * a.ldlt().solve(body.kept_rows().transpose());
    EXPECT_LT((g * d.asDiagonal() * g.transpose() - truth).norm(), 1e-9 * truth.norm()) << dt;
  }
  // Velocity and force of a row are those of the full model, since velocity and load of the body are.
  const MatX g_full = participation(full.reduced, full.rows).topRows(small.rows);
  VecX velocity(SpringBody::dofs), before(SpringBody::dofs), force(SpringBody::dofs), force_before(SpringBody::dofs);
  for (std::size_t s = 0; s < std::size_t(SpringBody::dofs); ++s) {
    velocity[long(s)] = small.reduced.modes[s].velocity;
    before[long(s)] = full.reduced.modes[s].velocity;
    force[long(s)] = small.reduced.modes[s].force;
    force_before[long(s)] = full.reduced.modes[s].force;
  }
  EXPECT_LT((g * velocity - g_full * before).norm(), 1e-9 * (g_full * before).norm());
  // The answer to the force over the step: A'^-1 f.
  const Eigen::GeneralizedSelfAdjointEigenSolver<MatX> modes(body.mass, body.system(body.h));
  const VecX f = body.system(body.h) * modes.eigenvectors() * force_before;  // V^T f = force_before
  const MatX a = body.system(body.h) + h_e.transpose() * h_e / body.compliance;
  const VecX answer = body.kept_rows() * a.ldlt().solve(f);
  EXPECT_LT((g * force - answer).norm(), 1e-9 * answer.norm());
}

TEST(CondenseModes, AFewModesLeaveAPositiveRest) {
  const SpringBody body;
  ConstraintProblem full = body.problem(), few = full;
  const std::vector<ReducedModel::Mode> kept(full.reduced.modes.end() - 4, full.reduced.modes.end());
  few.reduced.clear();
  few.reduced.add_group(kept, SpringBody::rows);
  for (std::size_t i = 0; i < std::size_t(SpringBody::rows); ++i)
    std::copy_n(full.reduced.row(i) + SpringBody::dofs - 4, 4, few.reduced.row(i));
  ConstraintProblem small;
  Condenser()(few, SpringBody::at_tool, small);
  ASSERT_EQ(small.reduced.size(), 4);
  const MatX w = testing::w_of(small);
  const MatX g = participation(small.reduced, small.rows);
  EXPECT_GT(Eigen::SelfAdjointEigenSolver<MatX>(w - g * g.transpose()).eigenvalues().minCoeff(), -1e-12 * w.norm());
  for (const ReducedModel::Mode& m : small.reduced.modes) {
    EXPECT_GE(m.mass_s2, 0);
    EXPECT_GE(m.stiffness(small.step_s), -1e-12);
  }
}

}  // namespace
}  // namespace insula
