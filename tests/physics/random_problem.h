// SPDX-License-Identifier: GPL-3.0-or-later
// Random constraint problems, and the distance of a solution from the laws.
#pragma once
#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>

#include "core/base/random.h"
#include "core/constraint/solve.h"

namespace insula::test {

inline MatX random_matrix(Random& random, int rows, int columns) {
  MatX m(rows, columns);
  for (int i = 0; i < rows; ++i)
    for (int j = 0; j < columns; ++j) m(i, j) = random.uniform(-1, 1);
  return m;
}

/// Largest violation of the contact laws, relative to the sizes at hand.
inline double contact_error(const Vec3& delta, const Vec3& lambda, double mu, double length, double force) {
  double error = std::max(-delta[0] / length, -lambda[0] / force);
  error = std::max(error, std::min(std::abs(delta[0]) / length, std::abs(lambda[0]) / force));
  const Eigen::Vector2d slip = delta.tail<2>(), f = lambda.tail<2>();
  error = std::max(error, (f.norm() - mu * lambda[0]) / force);            // cone
  if (lambda[0] > 1e-12 * force && slip.norm() > 1e-9 * length && mu > 0)  // slips: on the cone, opposite to the slip
    error = std::max({error, std::abs(f.norm() - mu * lambda[0]) / force,
                      (f + mu * lambda[0] * slip / slip.norm()).norm() / force * std::min(1.0, slip.norm() / length)});
  return error;
}

/// Makes the blocks of a random problem, one after the other.
class RandomBlocks {
 public:
  RandomBlocks(Random& random, double friction) : random_(random), friction_(friction) {}

  void add() {
    Block b;
    const int self = int(blocks.size());
    switch (random_.below(7)) {
      case 0: break;                                          // bilateral
      case 1: b.compliance = random_.uniform(0.1, 2); break;  // two-sided spring
      case 2:
        b.compliance = random_.uniform(0.1, 2);
        b.upper = 0;
        break;                     // fibre
      case 3: b.lower = 0; break;  // contact without friction
      case 4:
        b.upper = random_.uniform(0.1, 1);
        b.lower = -b.upper;
        break;  // plastic hold
      case 5: b = patch(self); break;
      default: b.law = LawKind::friction; b.friction = friction_ * random_.uniform(0.1, 1);
    }
    append(b, self);
  }

  int rows = 0;
  std::vector<Block> blocks;
  std::vector<int> with;  ///< of each block: the block whose bodies it shares

 private:
  /// Adds contacts that share a friction force. Returns the block of this force.
  Block patch(int self) {
    const int normals = 1 + int(random_.below(4));
    Block contact;
    contact.lower = 0;
    if (random_.below(3) == 0) contact.compliance = random_.uniform(0.1, 1);
    for (int k = 0; k < normals; ++k) append(contact, self);
    Block b;
    b.law = LawKind::patch;
    b.friction = friction_ * random_.uniform(0.1, 1);
    b.normals = normals;
    return b;
  }
  void append(Block b, int same) {
    b.id = std::uint64_t(100 + blocks.size());
    b.row = rows;
    rows += b.rows();
    with.push_back(same);
    blocks.push_back(b);
  }

  Random& random_;
  double friction_;
};

/// Random Jacobian in which each row acts on two of the bodies, so the coupling is sparse as in a scene.
inline MatX random_jacobian(Random& random, const RandomBlocks& made) {
  const int bodies = 3 + int(random.below(4)), dof = 6;
  MatX h = MatX::Zero(made.rows, bodies * dof);
  int one = 0, two = 0;
  for (std::size_t i = 0; i < made.blocks.size(); ++i) {
    const Block& b = made.blocks[i];
    if (made.with[i] == int(i)) {
      one = int(random.below(std::uint32_t(bodies)));
      two = int(random.below(std::uint32_t(bodies)));
    }
    for (int k = 0; k < b.rows(); ++k) {
      h.row(b.row + k).segment(one * dof, dof) += random_matrix(random, 1, dof);
      if (two != one) h.row(b.row + k).segment(two * dof, dof) -= random_matrix(random, 1, dof);
    }
  }
  return h;
}

/// Contacts, patches, fibres, holds and links among a few bodies of several degrees of freedom: W = H A^-1 H^T plus a
/// small diagonal, so that the solution is unique.
inline ConstraintProblem random_problem(Random& random, double friction) {
  ConstraintProblem p;
  const int blocks = 2 + int(random.below(9));
  RandomBlocks made(random, friction);
  for (int i = 0; i < blocks; ++i) made.add();
  p.resize(made.rows);
  p.blocks = made.blocks;
  const MatX h = random_jacobian(random, made);
  const MatX w = h * h.transpose() + 0.05 * MatX::Identity(made.rows, made.rows);
  for (int i = 0; i < made.rows; ++i) {
    for (int j = 0; j < made.rows; ++j) p.w[std::size_t(i * p.stride + j)] = 0.5 * (w(i, j) + w(j, i));
    p.delta_free[std::size_t(i)] = random.uniform(-1, 1);
  }
  return p;
}

/// The same for a patch whose contacts have the total normal force `bound` / mu.
inline double patch_error(const Eigen::Vector2d& slip, const Eigen::Vector2d& f, double bound, double length,
                          double force) {
  double error = (f.norm() - bound) / force;
  error = std::max(error, std::min(slip.norm() / length, (bound - f.norm()) / force));  // slips only on the bound ...
  if (slip.norm() > 1e-9 * length)                                                      // ... and against the force
    error = std::max(error, (f + bound * slip / slip.norm()).norm() / force * std::min(1.0, slip.norm() / length));
  return error;
}

inline double law_error(const ConstraintProblem& p, const std::vector<double>& lambda) {
  VecX delta(p.rows);
  double length = 1e-300, force = 1e-300;
  for (int i = 0; i < p.rows; ++i) {
    delta[i] = p.delta_free[std::size_t(i)];
    for (int j = 0; j < p.rows; ++j) delta[i] += p.w_at(i, j) * lambda[std::size_t(j)];
    length = std::max(length, std::abs(p.delta_free[std::size_t(i)]));
    force = std::max(force, std::abs(lambda[std::size_t(i)]));
  }
  double error = 0;
  for (const Block& b : p.blocks) {
    const double* l = lambda.data() + b.row;
    if (b.law == LawKind::friction) {
      error =
          std::max(error, contact_error(delta.segment<3>(b.row), Vec3(l[0], l[1], l[2]), b.friction, length, force));
      continue;
    }
    if (b.law == LawKind::patch) {
      double pressed = 0;
      for (int i = 1; i <= b.normals; ++i) pressed += l[-i];
      error = std::max(error, patch_error(delta.segment<2>(b.row), {l[0], l[1]}, b.friction * pressed, length, force));
      continue;
    }
    const double d = (delta[b.row] + b.compliance * l[0]) / length;
    error = std::max({error, (b.lower - l[0]) / force, (l[0] - b.upper) / force});
    if (l[0] <= b.lower) error = std::max(error, -d);  // pushed against its lower bound: may open
    else if (l[0] >= b.upper) error = std::max(error, d);
    else error = std::max(error, std::abs(d));
  }
  return error;
}

inline SolveStats solve_to(const ConstraintProblem& p, SolveWorkspace& ws, int sweeps, double tolerance,
                           bool conjugate) {
  ws.reserve(p.rows);
  return solve(p, p.delta_free, {sweeps, tolerance, conjugate}, ws);
}

/// All laws are within their bounds, up to rounding.
inline void expect_bounds(const ConstraintProblem& p, const std::vector<double>& lambda) {
  for (const Block& b : p.blocks) {
    const double* l = lambda.data() + b.row;
    if (b.law == LawKind::box) {
      EXPECT_GE(l[0], b.lower);
      EXPECT_LE(l[0], b.upper);
    } else if (b.law == LawKind::patch) {
      double pressed = 0;
      for (int i = 1; i <= b.normals; ++i) pressed += l[-i];
      EXPECT_LE(std::hypot(l[0], l[1]), b.friction * pressed * (1 + 1e-12));
    } else {
      EXPECT_GE(l[0], 0);
      EXPECT_LE(std::hypot(l[1], l[2]), b.friction * l[0] * (1 + 1e-12));
    }
  }
}

}  // namespace insula::test
