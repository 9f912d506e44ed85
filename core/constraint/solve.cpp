// SPDX-License-Identifier: GPL-3.0-or-later
// Block Gauss-Seidel with residual updates: delta is kept current, so a block that does not move costs nothing.
//
// On request lambda is carried on between sweeps along a conjugate direction (nonsmooth nonlinear conjugate gradients; Silcowitz, Niebe,
// Erleben 2010): with g what a sweep moves lambda by, beta = |g_k|^2 / |g_k-1|^2, p_k = beta p_k-1 + g_k, lambda += beta p_k-1;
// beta > 1 starts anew. A stiff clip on a thin wall takes a tenth of the sweeps. W p follows from the deltas before and
// after a sweep, so it costs no product with W. The last thing done to lambda is always a sweep, which keeps every law.
#include "core/constraint/solve.h"

#include <algorithm>
#include <cmath>

#include "core/constraint/friction.h"
#include "core/linalg/kernels.h"

namespace insula {

void SolveWorkspace::reserve(int rows) {
  const std::size_t n = std::size_t(rows) + 8;
  if (lambda.capacity() < n) lambda.reserve(n);
  if (delta.capacity() < n) delta.reserve(n);
  for (std::vector<double>* v : {&before, &before_delta, &along, &along_delta})
    if (v->capacity() < n) v->reserve(n);
}

namespace {

// The block's lambda that satisfies its law while the other blocks keep theirs.
void local_solution(const ConstraintProblem& p, const Block& b, const double* lambda, const double* delta, double* out) {
  const int r = b.row;
  const double* w = p.w.data() + std::size_t(r) * p.stride + r;
  if (b.law == LawKind::box) {
    const double a = w[0] + b.compliance;
    if (!(a > 0)) {
      out[0] = lambda[r];
      return;
    }
    out[0] = std::clamp(lambda[r] - (delta[r] + b.compliance * lambda[r]) / a, b.lower, b.upper);
    return;
  }
  const int s = p.stride;
  if (b.law == LawKind::patch) {
    double pressed = 0;
    for (int i = r - b.normals; i < r; ++i) pressed += std::max(0.0, lambda[i]);
    const double q1 = delta[r] - (w[0] * lambda[r] + w[1] * lambda[r + 1]), q2 = delta[r + 1] - (w[1] * lambda[r] + w[s + 1] * lambda[r + 1]);
    return solve_disc(w[0], w[1], w[s + 1], q1, q2, b.friction * pressed, out);
  }
  LocalContact c;
  c.wnn = w[0] + b.compliance;
  c.wn1 = w[1];
  c.wn2 = w[2];
  c.w11 = w[s + 1];
  c.w12 = w[s + 2];
  c.w22 = w[2 * s + 2];
  // Violation with this block's own lambda taken out.
  const double l0 = lambda[r], l1 = lambda[r + 1], l2 = lambda[r + 2];
  c.qn = delta[r] - (w[0] * l0 + w[1] * l1 + w[2] * l2);
  c.q1 = delta[r + 1] - (w[s] * l0 + w[s + 1] * l1 + w[s + 2] * l2);
  c.q2 = delta[r + 2] - (w[2 * s] * l0 + w[2 * s + 1] * l1 + w[2 * s + 2] * l2);
  solve_contact(c, b.friction, out);
}

void full_delta(const Kernels& k, const ConstraintProblem& p, std::span<const double> free, const double* lambda, double* delta) {
  std::copy(free.begin(), free.end(), delta);
  for (int i = 0; i < p.rows; ++i)
    if (lambda[i] != 0) k.axpy(delta, p.w.data() + std::size_t(i) * p.stride, lambda[i], p.rows);
}

// Moves lambda and delta along the conjugate direction after a sweep; returns the sweep's size.
double carry_on(const ConstraintProblem& p, SolveWorkspace& ws, double last_norm) {
  const std::size_t n = std::size_t(p.rows), diagonal = std::size_t(p.stride) + 1;
  double norm = 0;
  for (std::size_t i = 0; i < n; ++i) {
    const double g = ws.lambda[i] - ws.before[i];
    norm += g * g * p.w[i * diagonal];
  }
  const double beta = last_norm > 0 ? norm / last_norm : 2;
  const bool anew = !(beta <= 1);
  for (std::size_t i = 0; i < n; ++i) {
    const double g = ws.lambda[i] - ws.before[i], wg = ws.delta[i] - ws.before_delta[i];
    if (anew) {
      ws.along[i] = g;
      ws.along_delta[i] = wg;
      continue;
    }
    ws.along[i] *= beta;
    ws.along_delta[i] *= beta;
    ws.lambda[i] += ws.along[i];
    ws.delta[i] += ws.along_delta[i];
    ws.along[i] += g;
    ws.along_delta[i] += wg;
  }
  return norm;
}

}  // namespace

SolveStats solve(const ConstraintProblem& p, std::span<const double> free, const SolveSettings& settings, SolveWorkspace& ws) {
  const Kernels& k = kernels();
  const int n = p.rows;
  ws.lambda.resize(std::size_t(n));
  ws.delta.resize(std::size_t(n));
  double* lambda = ws.lambda.data();
  double* delta = ws.delta.data();
  SolveStats stats;
  if (n == 0) return stats;
  full_delta(k, p, free.first(std::size_t(n)), lambda, delta);

  for (std::vector<double>* v : {&ws.before, &ws.before_delta, &ws.along, &ws.along_delta}) v->assign(std::size_t(n), 0.0);
  double last_norm = 0;  // of the sweep before, 0: no direction yet

  double next[3];
  for (stats.sweeps = 0; stats.sweeps < settings.max_sweeps;) {
    double moved = 0;
    std::copy_n(lambda, n, ws.before.data());
    std::copy_n(delta, n, ws.before_delta.data());
    for (const Block& b : p.blocks) {
      local_solution(p, b, lambda, delta, next);
      const int r = b.row;
      const double* w = p.w.data() + std::size_t(r) * p.stride;
      if (b.law == LawKind::box) {
        const double d = next[0] - lambda[r];
        if (d == 0) continue;
        k.axpy(delta, w, d, n);
        lambda[r] = next[0];
        moved = std::max(moved, std::abs(d) * (w[r] + b.compliance));
      } else if (b.law == LawKind::patch) {
        for (int i = 0; i < 2; ++i) {
          const double d = next[i] - lambda[r + i];
          const double* row = w + i * p.stride;
          if (d != 0) k.axpy(delta, row, d, n);
          lambda[r + i] = next[i];
          moved = std::max(moved, std::abs(d) * row[r + i]);
        }
      } else {
        const double d0 = next[0] - lambda[r], d1 = next[1] - lambda[r + 1], d2 = next[2] - lambda[r + 2];
        if (d0 == 0 && d1 == 0 && d2 == 0) continue;
        k.axpy3(delta, w, w + p.stride, w + 2 * p.stride, d0, d1, d2, n);
        lambda[r] = next[0];
        lambda[r + 1] = next[1];
        lambda[r + 2] = next[2];
        moved = std::max({moved, std::abs(d0) * w[r], std::abs(d1) * w[p.stride + r + 1], std::abs(d2) * w[2 * p.stride + r + 2]});
      }
    }
    ++stats.sweeps;
    if (moved <= settings.tolerance_m || stats.sweeps >= settings.max_sweeps) break;
    if (settings.conjugate) last_norm = carry_on(p, ws, last_norm);
  }

  // Residual on a delta computed afresh: what each law would still move.
  full_delta(k, p, free.first(std::size_t(n)), lambda, delta);
  for (const Block& b : p.blocks) {
    local_solution(p, b, lambda, delta, next);
    for (int i = 0; i < b.rows(); ++i) {
      const double d = std::abs(next[i] - lambda[b.row + i]);
      stats.residual_N = std::max(stats.residual_N, d);
      stats.residual_m = std::max(stats.residual_m, d * p.w_at(b.row + i, b.row + i));
    }
  }
  return stats;
}

}  // namespace insula
