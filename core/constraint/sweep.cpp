// SPDX-License-Identifier: GPL-3.0-or-later
// Exact local solutions, and the data of each block that a sweep needs.
#include "core/constraint/sweep.h"

#include <algorithm>
#include <cmath>

#include "core/constraint/friction.h"
#include "core/linalg/instruction_set.h"

namespace insula {
INSULA_TABLES(SweepKernels, sweep_table)

const SweepKernels& sweep_kernels() { return every_sweep_table().chosen(); }

void local_solution(const ConstraintProblem& p, const Block& b, const double* lambda, const double* delta,
                    double* out) {
  const int r = b.row;
  const double* w = p.w.data() + std::size_t(r) * p.stride + r;
  if (b.law == LawKind::box) {
    const double a = w[0] + b.compliance;
    if (!(a > 0)) {
      out[0] = std::clamp(lambda[r], b.lower, b.upper);
      return;
    }
    out[0] = std::clamp(lambda[r] - (delta[r] + b.compliance * lambda[r]) / a, b.lower, b.upper);
    return;
  }
  const int s = p.stride;
  if (b.law == LawKind::patch) {
    double pressed = 0;
    for (int i = r - b.normals; i < r; ++i) pressed += std::max(0.0, lambda[i]);
    const double q1 = delta[r] - (w[0] * lambda[r] + w[1] * lambda[r + 1]),
                 q2 = delta[r + 1] - (w[1] * lambda[r] + w[s + 1] * lambda[r + 1]);
    return solve_disc(w[0], w[1], w[s + 1], q1, q2, b.friction * pressed, out);
  }
  LocalContact c;
  c.wnn = w[0] + b.compliance;
  c.wn1 = w[1];
  c.wn2 = w[2];
  c.w11 = w[s + 1];
  c.w12 = w[s + 2];
  c.w22 = w[2 * s + 2];
  // Violation without this block's own lambda.
  const double l0 = lambda[r], l1 = lambda[r + 1], l2 = lambda[r + 2];
  c.qn = delta[r] - (w[0] * l0 + w[1] * l1 + w[2] * l2);
  c.q1 = delta[r + 1] - (w[s] * l0 + w[s + 1] * l1 + w[s + 2] * l2);
  c.q2 = delta[r + 2] - (w[2 * s] * l0 + w[2 * s + 1] * l1 + w[2 * s + 2] * l2);
  solve_contact(c, b.friction, out);
}

namespace {

constexpr double min_ratio = 1e-9;  // of the eigenvalues of a block, below which its inverse is not used

void set_up_tangents(LocalBlock& l, double s11, double s12, double s22) {
  const Eigen2 eigen(s11, s12, s22);
  l.high = eigen.high;
  l.low = eigen.low;
  l.vx = eigen.vx;
  l.vy = eigen.vy;
}

void set_up_friction(LocalBlock& l, const double* w, int s) {
  const double wnn = w[0] + l.compliance, wn1 = w[1], wn2 = w[2];
  if (!(wnn > 0)) return;
  const double i = l.inverse_normal = 1 / wnn;
  const double s11 = w[s + 1] - wn1 * wn1 * i, s12 = w[s + 2] - wn1 * wn2 * i, s22 = w[2 * s + 2] - wn2 * wn2 * i;
  set_up_tangents(l, s11, s12, s22);
  l.m1 = l.vx * wn1 + l.vy * wn2;
  l.m2 = -l.vy * wn1 + l.vx * wn2;
  l.regular = l.friction > 0 && l.low > min_ratio * (l.high + wnn);
  if (!l.regular) return;
  // By the Schur complement: tangential part S^-1, normal part bordered.
  const double d = 1 / (s11 * s22 - s12 * s12), t11 = s22 * d, t12 = -s12 * d, t22 = s11 * d;
  const double n1 = -i * (wn1 * t11 + wn2 * t12), n2 = -i * (wn1 * t12 + wn2 * t22);
  const double inverse[6] = {i - i * (wn1 * n1 + wn2 * n2), n1, n2, t11, t12, t22};
  std::copy_n(inverse, 6, l.inverse);
}

void set_up_patch(LocalBlock& l, const double* w, int s) {
  set_up_tangents(l, w[0], w[1], w[s + 1]);
  l.regular = l.high > 0 && l.low > min_ratio * l.high;
  if (!l.regular) return;
  const double d = 1 / (w[0] * w[s + 1] - w[1] * w[1]);
  l.inverse[0] = w[s + 1] * d;
  l.inverse[1] = -w[1] * d;
  l.inverse[2] = w[0] * d;
}

void exact(const ConstraintProblem& p, int block, const double* lambda, const double* delta, double* out) {
  local_solution(p, p.blocks[std::size_t(block)], lambda, delta, out);
}

LocalBlock local_block(const ConstraintProblem& p, const Block& b) {
  LocalBlock l;
  l.row = b.row;
  l.law = b.law;
  l.normals = b.normals;
  l.compliance = b.compliance;
  l.lower = b.lower;
  l.upper = b.upper;
  l.friction = b.friction;
  const double* w = p.w.data() + std::size_t(b.row) * p.stride + b.row;
  if (b.law == LawKind::friction) set_up_friction(l, w, p.stride);
  else if (b.law == LawKind::patch) set_up_patch(l, w, p.stride);
  else if (w[0] + b.compliance > 0) l.inverse[0] = 1 / (w[0] + b.compliance);
  return l;
}

}  // namespace

SweepData SweepMemory::set_up(const ConstraintProblem& p) {
  blocks.clear();
  for (const Block& b : p.blocks) blocks.push_back(local_block(p, b));
  return {&p, p.w.data(), p.stride, blocks.data(), int(blocks.size()), exact};
}

}  // namespace insula
