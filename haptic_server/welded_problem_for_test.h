// SPDX-License-Identifier: GPL-3.0-or-later
// A problem with a tool that grasps a clip, for the servo's tests.
#pragma once
#include "haptic_server/problem_for_test.h"

namespace insula::testing {

/// A tool at the origin that grasps a clip. The clip has `contacts` contacts at the distance `reach` below. Six rows
/// between them follow the `own` rows of the tool.
inline ConstraintProblem with_clip(int contacts, int own, std::uint64_t seed) {
  constexpr double step_s = 1.0 / 60, mass_kg = 0.03, inertia = 1.2e-5, lever = 5e-3, reach = 0.01;
  Random random(seed);
  const int n = own + 6 + contacts;
  ConstraintProblem p;
  p.resize(n);
  p.step_s = step_s;
  ToolTerms t;
  t.hand = 1;
  t.free = displaced(t.device, (Vec6() << 2e-4, -1e-4, 3e-4, 0.002, 0.001, -0.003).finished());
  t.stiffness.diagonal() << 300, 300, 300, 0.3, 0.3, 0.3;
  t.compliance = t.stiffness.inverse();
  t.jacobian.setZero(n, 6);
  Eigen::Matrix<double, Eigen::Dynamic, 6> clip = Eigen::Matrix<double, Eigen::Dynamic, 6>::Zero(n, 6);
  Mat6 give = Mat6::Zero();
  give.diagonal().head<3>().setConstant(step_s * step_s / mass_kg);
  give.diagonal().tail<3>().setConstant(step_s * step_s / inertia);
  for (int k = 0; k < 6; ++k) {
    clip(own + k, k) = k < 3 ? 1 : lever;
    t.jacobian.row(own + k) = -clip.row(own + k);
    p.blocks.push_back(
        {.id = (std::uint64_t(7) << 44) + std::uint64_t(k), .owner = 7, .role = BlockRole::weld, .row = own + k});
  }
  std::vector<Block> before;
  for (int i = 0; i < n; ++i) {
    if (i >= own && i < own + 6) continue;
    const Vec3 d = random.vector(1).normalized(), arm = Vec3(0, 0, -reach) + random.vector(2e-3);
    const Vec6 row = (Vec6() << d, arm.cross(d)).finished();
    if (i < own) t.jacobian.row(i) = row.transpose();
    else clip.row(i) = row.transpose();
    p.retardation_time[std::size_t(i)] = 0.02;
    p.delta_free[std::size_t(i)] = -2e-4 + 2e-4 * random.next();
    (i < own ? before : p.blocks).push_back({.id = std::uint64_t(i + 1), .row = i, .lower = 0});
  }
  p.blocks.insert(p.blocks.begin(), before.begin(), before.end());
  MatX w = 4e-3 * MatX::Identity(n, n);
  for (int k = 0; k < 6; ++k) w(own + k, own + k) = 0;
  w += t.jacobian * t.compliance * t.jacobian.transpose() + clip * give * clip.transpose();
  set_w(p, w);
  p.tools.push_back(t);
  return p;
}

}  // namespace insula::testing
