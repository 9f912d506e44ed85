// SPDX-License-Identifier: GPL-3.0-or-later
// Difficult problems for block Gauss-Seidel, with solutions in closed form if there are any.
#pragma once
#include "tests/physics/random_problem.h"

namespace insula::test {

inline ConstraintProblem problem_of(const MatX& w, const VecX& free, const std::vector<Block>& blocks) {
  ConstraintProblem p;
  p.resize(int(free.size()));
  int row = 0;
  for (Block b : blocks) {
    b.id = std::uint64_t(100 + row);
    b.row = row;
    row += b.rows();
    p.blocks.push_back(b);
  }
  for (int i = 0; i < p.rows; ++i) {
    for (int j = 0; j < p.rows; ++j) p.w[std::size_t(i * p.stride + j)] = 0.5 * (w(i, j) + w(j, i));
    p.delta_free[std::size_t(i)] = free[i];
  }
  return p;
}

inline Block contact(double friction) {
  Block b;
  if (friction > 0) {
    b.law = LawKind::friction;
    b.friction = friction;
  } else {
    b.lower = 0;
  }
  return b;
}

/// A slab, `mass` and (side, side, thickness), on side x side contacts with a table, weight on it and a push along x
/// through the plane of contact: W has rank six. In a step without memory a force F moves it by F / mass (h = 1).
struct Slab {
  static constexpr double mass = 2, gravity = 10, mu = 0.4;
  int side;
  double push;
  int contacts() const { return side * side; }
  ConstraintProblem problem() const {
    const double inertia = mass / 12 * side * side;
    Eigen::Matrix<double, 6, 6> inverse = Eigen::Matrix<double, 6, 6>::Zero();
    inverse.diagonal() << 1 / mass, 1 / mass, 1 / mass, 1 / inertia, 1 / inertia, 0.5 / inertia;
    MatX h(3 * contacts(), 6);
    for (int k = 0; k < contacts(); ++k) {
      const Vec3 r(k % side - 0.5 * (side - 1), k / side - 0.5 * (side - 1), 0);
      const Vec3 axes[3] = {Vec3::UnitZ(), Vec3::UnitX(), Vec3::UnitY()};
      for (int a = 0; a < 3; ++a) {
        h.row(3 * k + a).head<3>() = axes[a];
        h.row(3 * k + a).tail<3>() = r.cross(axes[a]);
      }
    }
    Eigen::Matrix<double, 6, 1> force = Eigen::Matrix<double, 6, 1>::Zero();
    force[0] = push;
    force[2] = -mass * gravity;
    return problem_of(h * inverse * h.transpose(), h * (inverse * force),
                      std::vector<Block>(std::size_t(contacts()), contact(mu)));
  }
};

/// `light` bodies of mass 1 in a column on the ground, one of mass `ratio` on top, gravity 1: contact k bears the
/// weight above it.
struct Column {
  int light;
  double ratio;
  ConstraintProblem problem() const {
    const int n = light + 1;
    MatX w = MatX::Zero(n, n);
    VecX free = VecX::Zero(n);
    const auto inverse = [&](int body) { return body < 0 ? 0.0 : body < light ? 1.0 : 1 / ratio; };
    for (int k = 0; k < n; ++k) {  // contact k: body k on body k - 1, or on the ground
      w(k, k) = inverse(k) + inverse(k - 1);
      if (k > 0) w(k, k - 1) = w(k - 1, k) = -inverse(k - 1);
      free[k] = k == 0 ? -1 : 0;  // all fall alike
    }
    return problem_of(w, free, std::vector<Block>(std::size_t(n), contact(0)));
  }
  double force(int k) const { return light - k + ratio; }
};

/// Two jaws, each of compliance `jaw`, close by `close` each on a chain of `nodes` light nodes of compliance 1 and
/// shear it by `shear`. The force is the same in the whole chain.
struct Jaws {
  int nodes;
  double jaw, close, shear, mu;
  ConstraintProblem problem() const {
    const int n = nodes + 1;
    MatX w = MatX::Zero(3 * n, 3 * n);
    VecX free = VecX::Zero(3 * n);
    for (int k = 0; k < n; ++k) {
      const bool end = k == 0 || k == nodes;
      for (int d = 0; d < 3; ++d) {
        w(3 * k + d, 3 * k + d) = end ? 1 + jaw : 2;
        if (k > 0) w(3 * k + d, 3 * k + d - 3) = w(3 * k + d - 3, 3 * k + d) = -1;
      }
      if (end) {
        free[3 * k] = -close;
        free[3 * k + 1] = shear;
      }
    }
    return problem_of(w, free, std::vector<Block>(std::size_t(n), contact(mu)));
  }
  double normal() const { return close / jaw; }
  double tangent() const { return -std::min(shear / jaw, mu * normal()); }
};

/// Contacts with friction that share few degrees of freedom: W of rank `rank`, and a little on its diagonal that makes
/// the answer one.
inline ConstraintProblem crowded(Random& random, int contacts, int rank, double own) {
  const int n = 3 * contacts;
  const MatX h = random_matrix(random, n, rank);
  VecX free(n);
  for (int i = 0; i < n; ++i) free[i] = random.uniform(-1, 1) - (i % 3 == 0 ? 0.5 : 0);
  return problem_of(h * h.transpose() / rank + own * MatX::Identity(n, n), free,
                    std::vector<Block>(std::size_t(contacts), contact(0.3)));
}

}  // namespace insula::test
