// SPDX-License-Identifier: GPL-3.0-or-later
// Explicit two-tool constraint problems for the servo's tests.
#pragma once
#include <cmath>
#include <cstdint>

#include "core/constraint/problem_for_test.h"
#include "core/constraint/solve.h"

namespace insula::testing {

/// Small deterministic generator (splitmix64), uniform in [-1, 1).
class Random {
 public:
  explicit Random(std::uint64_t seed) : state_(seed) {}
  std::uint64_t bits() {
    std::uint64_t z = (state_ += 0x9e3779b97f4a7c15ull);
    z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9ull;
    z = (z ^ (z >> 27)) * 0x94d049bb133111ebull;
    return z ^ (z >> 31);
  }
  double next() { return double(bits() >> 11) * 0x1p-52 - 1; }
  Vec3 vector(double size) {
    const double x = next(), y = next(), z = next();
    return size * Vec3(x, y, z);
  }

 private:
  std::uint64_t state_;
};

/// A massless tool held by a virtual coupling of 300 N/m and 0.3 N m/rad; inertia and damping keep it behind the
/// device.
inline ToolTerms held_tool(int hand, const Pose& device, int rows) {
  ToolTerms t;
  t.hand = hand;
  t.device = t.free = device;
  t.stiffness.setZero();
  t.stiffness.diagonal() << 300, 300, 300, 0.3, 0.3, 0.3;
  t.gain = 0.9 * Mat6::Identity();
  t.compliance = t.stiffness.inverse();
  t.jacobian.setZero(rows, 6);
  return t;
}

/// Numbers of contacts, strands and patches in a two-tool problem. Their rows have this order.
struct TwoToolRows {
  int contacts, strands, patches;
  int total() const { return 3 * contacts + strands + 5 * patches; }
  int first_of_strand(int s) const { return 3 * contacts + s; }
  int first_of_patch(int c) const { return 3 * contacts + strands + 5 * c; }
};

inline ToolTerms coupled_tool(int hand, int rows) {
  ToolTerms t;
  t.hand = hand;
  t.device.p = Vec3(hand ? 0.02 : -0.02, 0.01, 0.03);
  t.device.q = from_rotation_vector(Vec3(0.1, hand ? -0.3 : 0.2, 0.4));
  t.free = displaced(t.device, (Vec6() << 2e-4, -1e-4, 3e-4, 0.002, 0.001, -0.003).finished());
  t.stiffness.setZero();
  t.stiffness.diagonal() << 300, 300, 300, 0.3, 0.3, 0.3;
  Mat6 a = t.stiffness * 1.12;  // coupling, its damping and the tool's inertia
  a.diagonal().array() += Eigen::Array<double, 6, 1>(20, 20, 20, 0.01, 0.01, 0.01);
  t.compliance = a.inverse();
  t.gain = t.compliance * (t.stiffness * 1.12);
  t.jacobian.setZero(rows, 6);
  return t;
}

/// Sets Jacobians of frictional contacts: orthonormal directions at one point.
inline void set_contact_jacobians(ConstraintProblem& p, const TwoToolRows& rows, Random& random) {
  for (int c = 0; c < rows.contacts; ++c) {
    const int hand = c % 2;
    const Vec3 normal = random.vector(1).normalized();
    const Vec3 t1 = normal.unitOrthogonal();
    const Vec3 arm = random.vector(0.01);
    const Vec3 axes[3] = {normal, t1, normal.cross(t1)};
    for (int k = 0; k < 3; ++k) {
      auto& h = p.tools[std::size_t(hand)].jacobian;
      p.tools[std::size_t(1 - hand)].jacobian.row(3 * c + k).setZero();
      h.row(3 * c + k) << axes[k].transpose(), arm.cross(axes[k]).transpose();
    }
  }
}

/// Sets Jacobians of patches: three normals in one direction, and the two tangents of their mean.
inline void set_patch_jacobians(ConstraintProblem& p, const TwoToolRows& rows, Random& random) {
  for (int c = 0; c < rows.patches; ++c) {
    const int hand = c % 2, row = rows.first_of_patch(c);
    const Vec3 normal = random.vector(1).normalized(), t1 = normal.unitOrthogonal(), t2 = normal.cross(t1);
    auto& h = p.tools[std::size_t(hand)].jacobian;
    h.middleRows(row, 5).setZero();
    p.tools[std::size_t(1 - hand)].jacobian.middleRows(row, 5).setZero();
    for (int k = 0; k < 3; ++k) {
      const Vec3 arm = random.vector(0.01);
      h.row(row + k) << normal.transpose(), arm.cross(normal).transpose();
      for (int j = 0; j < 2; ++j) {
        const Vec3& t = j == 0 ? t1 : t2;
        h.row(row + 3 + j) += (Vec6() << t, arm.cross(t)).finished().transpose() / 3;
      }
    }
  }
}

/// Adds the blocks. The gaps of contacts and patches are half a millimetre smaller than those of other rows.
inline void add_two_tool_blocks(ConstraintProblem& p, const TwoToolRows& rows) {
  const auto add = [&](std::uint64_t id, int row) -> Block& {
    Block& b = p.blocks.emplace_back();
    b.id = id;
    b.row = row;
    return b;
  };
  for (int c = 0; c < rows.contacts; ++c) {
    Block& b = add(1000 + std::uint64_t(c), 3 * c);
    b.law = LawKind::friction;
    b.friction = 0.3;
    p.delta_free[std::size_t(3 * c)] -= 5e-4;
  }
  for (int s = 0; s < rows.strands; ++s) {
    Block& b = add(5000 + std::uint64_t(s), rows.first_of_strand(s));
    b.compliance = 1 / 150.0;
    b.upper = 0;
  }
  for (int c = 0; c < rows.patches; ++c) {
    const int row = rows.first_of_patch(c);
    for (int k = 0; k < 3; ++k) {
      add(9000 + std::uint64_t(4 * c + k), row + k).lower = 0;
      p.delta_free[std::size_t(row + k)] -= 5e-4;
    }
    Block& b = add(9000 + std::uint64_t(4 * c + 3), row + 3);
    b.law = LawKind::patch;
    b.friction = 0.3;
    b.normals = 3;
  }
}

/// Two tools, each with a virtual coupling of 300 N/m and 0.3 N m/rad and a rigid-body compliance. They have `contacts`
/// frictional contacts, `strands` compliant rows and `patches` of three contacts with a common friction force, on soft
/// bodies. W = H C H^T (tools) + a soft part, as an engine builds it.
inline ConstraintProblem two_tool_problem(int contacts, int strands, std::uint64_t seed = 1, int patches = 0) {
  Random random(seed);
  ConstraintProblem p;
  const TwoToolRows rows{contacts, strands, patches};
  const int n = rows.total();
  p.resize(n);
  for (int hand = 0; hand < 2; ++hand) p.tools.push_back(coupled_tool(hand, n));
  MatX soft(n, n);
  for (int i = 0; i < n; ++i)
    for (int j = 0; j < n; ++j) soft(i, j) = random.next();
  MatX w = 1e-3 / n * (soft * soft.transpose()) + 1e-3 * MatX::Identity(n, n);
  for (int i = 0; i < n; ++i) {
    const int hand = (i / 3) % 2;
    const Vec3 d = random.vector(1).normalized();
    const Vec3 arm = random.vector(0.01);
    p.tools[std::size_t(hand)].jacobian.row(i) << d.transpose(), arm.cross(d).transpose();
  }
  set_contact_jacobians(p, rows, random);
  set_patch_jacobians(p, rows, random);
  for (const ToolTerms& t : p.tools) w += t.jacobian * t.compliance * t.jacobian.transpose();
  set_w(p, w);
  for (int i = 0; i < n; ++i) p.delta_free[std::size_t(i)] = 1e-3 * random.next();
  add_two_tool_blocks(p, rows);
  return p;
}

/// The engine's part: solves accurately and stores lambda in the problem.
inline void solve_as_engine(ConstraintProblem& p) {
  SolveWorkspace ws;
  ws.reserve(p.rows);
  ws.lambda = p.lambda;
  SolveSettings s;
  s.max_sweeps = 5000;
  s.tolerance_m = 1e-14;
  solve(p, p.delta_free, s, ws);
  p.lambda = ws.lambda;
}

}  // namespace insula::testing
