// SPDX-License-Identifier: GPL-3.0-or-later
// Problems with a surface patch under a ball, for tests of contacts that are found in each tick.
#pragma once
#include "core/constraint/problem.h"
#include "haptic_server/problem_for_test.h"

namespace insula::testing {

inline constexpr double patched_radius_m = 1e-3;

/// A ball of 1 mm without mass on a coupling of 300 N/m and 0.3 N m/rad, whose centre is the tool's origin.
inline ToolTerms ball_tool(const Vec3& centre, int rows) {
  ToolTerms t = held_tool(1, {centre, Quat::Identity()}, rows);
  t.gain.setIdentity();
  return t;
}

/// Adds the patch of a surface without rows yet, and a contact law of the ball on it.
inline void add_patch(ConstraintProblem& p, const std::vector<Vec3>& vertices,
                      const std::vector<std::array<int, 3>>& triangles, double friction) {
  for (const Vec3& x : vertices) p.patches.vertices.push_back({-1, x});
  for (const auto& t : triangles)
    p.patches.triangles.push_back({{std::int16_t(t[0]), std::int16_t(t[1]), std::int16_t(t[2])}, 0});
  p.patches.core.push_back(Vec3::Zero());
  PatchPiece piece;
  piece.cores = 1;
  piece.radius = patched_radius_m;
  p.patches.pieces.push_back(piece);
  SurfacePatch patch;
  patch.id = 7;
  patch.friction = friction;
  patch.alarm_m = patch.max_correction_m = 1e-3;
  patch.spacing_m = 0.5e-3;
  patch.max_contacts = patch.max_per_piece = 4;
  patch.triangles = int(triangles.size());
  patch.pieces = 1;
  p.patches.patches.push_back(patch);
}

/// Compliance of one row over a step: a vertex on a spring k and a damper beta k to the ground.
struct SoftVertex {
  double stiffness = 100, beta = 0.02;  // N/m, s
  double compliance(double h) const { return 1 / (stiffness * (1 + beta / h)); }
};

/// A triangle in z = 0 about the origin, each corner a SoftVertex in all directions. The ball's centre is at `centre`.
/// `as_rows`: a contact of the step in its middle is there in place of the patch.
inline ConstraintProblem soft_triangle(const SoftVertex& vertex, const Vec3& centre, double h, double friction,
                                       bool as_rows, double load_N = 0) {
  const double a = 2e-3;
  const std::vector<Vec3> corners{{-a, -a, 0}, {a, -a, 0}, {0, 2 * a, 0}};
  const int contact = 3, vertices = 9;
  ConstraintProblem p;
  p.resize(contact + (as_rows ? 0 : vertices));
  p.step_s = h;
  p.tools.push_back(ball_tool(centre, p.rows));
  const double w = vertex.compliance(h), share = 1.0 / 3;  // of a corner in the middle
  const Vec3 axes[3] = {Vec3::UnitZ(), Vec3::UnitX(), Vec3::UnitY()};
  const Vec3 arm(0, 0, -patched_radius_m);
  const auto at = [&](int i, int j) -> double& { return p.w[std::size_t(i * p.stride + j)]; };
  for (int k = 0; k < contact; ++k) {
    p.tools[0].jacobian.row(k) << axes[k].transpose(), arm.cross(axes[k]).transpose();
    at(k, k) = 3 * share * share * w;
  }
  for (int k = 0; k < contact; ++k)
    for (int l = 0; l < contact; ++l)
      at(k, l) += p.tools[0].jacobian.row(k) * p.tools[0].compliance * p.tools[0].jacobian.row(l).transpose();
  Block b;
  b.id = 1;
  b.role = BlockRole::contact;
  b.law = LawKind::friction;
  b.friction = friction;
  p.blocks.push_back(b);
  p.lambda[0] = load_N;
  // The gap at lambda is that of the ball and the square.
  for (int k = 0; k < p.rows; ++k) p.retardation_time[std::size_t(k)] = vertex.beta;
  p.tools[0].free =
      displaced(p.tools[0].device, -p.tools[0].compliance * p.tools[0].jacobian.row(0).transpose() * load_N);
  p.delta_free[0] = centre.z() - patched_radius_m - at(0, 0) * load_N;
  if (as_rows) return p;
  add_patch(p, corners, {{0, 1, 2}}, friction);
  for (int v = 0; v < 3; ++v) {
    p.patches.vertices[std::size_t(v)].row = contact + 3 * v;
    for (int k = 0; k < 3; ++k) {
      const int row = contact + 3 * v + k;
      Block s;
      s.id = std::uint64_t(100 + row);
      s.role = BlockRole::surface;
      s.row = row;
      s.lower = s.upper = 0;
      p.blocks.push_back(s);
      at(row, row) = w;
      for (int c = 0; c < contact; ++c) at(row, c) = at(c, row) = -share * axes[c][k] * w;
    }
    p.delta_free[std::size_t(contact + 3 * v + 2)] = share * w * load_N;
  }
  p.patches.replaced.push_back({0, 0, 0, Vec3::Constant(share)});
  p.patches.patches[0].replaced = 1;
  return p;
}

}  // namespace insula::testing
