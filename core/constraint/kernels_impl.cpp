// SPDX-License-Identifier: GPL-3.0-or-later
// The sweep, compiled once per instruction set: KERNEL_NAME, KERNEL_BYTES a vector. It uses no inline functions of
// other files, since these would be compiled for this instruction set and could be linked into other code.
#include "core/constraint/sweep_kernels.h"

namespace insula::KERNEL_NAME {
namespace {

constexpr int W = KERNEL_BYTES / 8;  // doubles a vector
typedef double V __attribute__((vector_size(W * 8), aligned(8)));

inline V load(const double* p) { return *reinterpret_cast<const V*>(p); }
inline void store(double* p, V v) { *reinterpret_cast<V*>(p) = v; }
inline double above(double least, double x) { return x < least ? least : x; }  // passes NaN through, as below
inline double below(double most, double x) { return x > most ? most : x; }
inline double size(double x) { return __builtin_fabs(x); }
inline double larger(double a, double b) { return a > b ? a : b; }

// --- local solutions -------------------------------------------------------------------------------------------------

struct Move {
  double d[3];
  int rows;  // 0: no change
};

inline Move move_box(const LocalBlock& b, double* lambda, double delta) {
  const double l = *lambda, low = b.lower - l, high = b.upper - l;
  const double d = below(high, above(low, -b.compliance * l * b.inverse[0] - delta * b.inverse[0]));
  *lambda = d == low ? b.lower : d == high ? b.upper : l + d;  // the bounds exactly
  return {{d, 0, 0}, d != 0 ? 1 : 0};
}

struct Three {
  double n, t1, t2;
};

// Solution for cases that the fast formulas below do not cover. Stores a start for the next slip, from (S + s) lambda_t
// = g.
__attribute__((noinline)) Three exact(const SweepData& data, int k, LocalBlock& b, const double* lambda,
                                      const double* delta, double g1, double g2) {
  double out[3] = {0, 0, 0};
  data.exact(*data.problem, k, lambda, delta, out);
  const double* t = b.law == LawKind::friction ? out + 1 : out;
  const double t1 = b.vx * t[0] + b.vy * t[1], t2 = -b.vy * t[0] + b.vx * t[1];
  const double s = (t1 * (g1 - b.high * t1) + t2 * (g2 - b.low * t2)) / (t1 * t1 + t2 * t2);
  b.slip = s > 0 ? s : -1;
  return {out[0], out[1], out[2]};
}

// Slip: |lambda_t| = mu lambda_n with (S + s) lambda_t = g and lambda_n = a0 + (a1 d2 + a2 d1) / (d1 d2), d = e + s.
// Multiplied by d1 d2 and squared, this is a polynomial in s. Newton's method starts from the last sweep's s and mostly
// needs one step. Its error is the square of the change of s, which vanishes with the sweeps. The result is projected
// onto the cone.
constexpr double slip_step = 0.03;  // relative to d2: a larger step is followed by another one

inline Three next_friction(const SweepData& data, int k, LocalBlock& b, const double* lambda, const double* delta) {
  const long s = data.stride;
  const int r = b.row;
  const double* w = data.w + r * s + r;
  const double l0 = lambda[r], l1 = lambda[r + 1], l2 = lambda[r + 2];
  // W lambda of the block itself, which is known before delta is.
  const double w0 = w[0] * l0 + w[1] * l1 + w[2] * l2, w1 = w[1] * l0 + w[s + 1] * l1 + w[s + 2] * l2,
               w2 = w[2] * l0 + w[s + 2] * l1 + w[2 * s + 2] * l2;
  const double i = b.inverse_normal, c1 = b.m1 * i, c2 = b.m2 * i;
  const double own1 = b.vx * w1 + b.vy * w2 - c1 * w0, own2 = b.vx * w2 - b.vy * w1 - c2 * w0;
  const double dn = delta[r], d1 = delta[r + 1], d2 = delta[r + 2];
  const double qn = dn - w0;
  if (qn >= 0) return {0, 0, 0};
  if (!b.regular) return exact(data, k, b, lambda, delta, 0, 0);
  const double mu2 = b.friction * b.friction;
  const double* v = b.inverse;
  const double c = dn + b.compliance * l0;
  const double n = l0 - (v[0] * c + v[1] * d1 + v[2] * d2);
  const double t1 = l1 - (v[1] * c + v[3] * d1 + v[4] * d2), t2 = l2 - (v[2] * c + v[4] * d1 + v[5] * d2);
  if (n > 0 && t1 * t1 + t2 * t2 <= mu2 * n * n) return {n, t1, t2};
  const double g1 = own1 - (b.vx * d1 + b.vy * d2 - c1 * dn), g2 = own2 - (b.vx * d2 - b.vy * d1 - c2 * dn);
  double slip = b.slip, e1 = b.high + slip, e2 = b.low + slip;
  if (!(slip >= 0)) return exact(data, k, b, lambda, delta, g1, g2);
  for (int step_count = 0;; ++step_count) {
    const double p1 = g1 * e2, p2 = g2 * e1, m = -i * (qn * (e1 * e2) + b.m1 * p1 + b.m2 * p2),
                 dm = -i * (qn * (e1 + e2) + b.m1 * g1 + b.m2 * g2);
    const double f = p1 * p1 + p2 * p2 - mu2 * m * m, df = 2 * (g1 * p1 + g2 * p2 - mu2 * m * dm);
    const double step = f / df;
    slip -= step;
    e1 -= step;
    e2 -= step;
    if (!(slip >= 0) || step_count == 4) return exact(data, k, b, lambda, delta, g1, g2);
    if (size(step) <= slip_step * e2) break;
  }
  const double p1 = g1 * e2, p2 = g2 * e1, area = e1 * e2, length2 = p1 * p1 + p2 * p2;
  const double normal = -i * (qn * area + b.m1 * p1 + b.m2 * p2) / area,
               scale = b.friction * normal / __builtin_sqrt(length2);
  // Newton's method may find another root. At the right one lambda_n > 0, and the result is nearly on the cone.
  if (!(normal > 0 && size(scale * area - 1) < 1e-2)) return exact(data, k, b, lambda, delta, g1, g2);
  b.slip = slip;
  return {normal, (b.vx * p1 - b.vy * p2) * scale, (b.vy * p1 + b.vx * p2) * scale};
}

// The same for friction of a given strength: |(S + s)^-1 g| = bound.
inline Three next_patch(const SweepData& data, int k, LocalBlock& b, const double* lambda, const double* delta) {
  const long s = data.stride;
  const int r = b.row;
  double pressed = 0;
  for (int i = r - b.normals; i < r; ++i) pressed += lambda[i] > 0 ? lambda[i] : 0;
  const double bound = b.friction * pressed, bound2 = bound * bound;
  if (!(bound > 0)) return {0, 0, 0};
  if (!b.regular) return exact(data, k, b, lambda, delta, 0, 0);
  const double* v = b.inverse;
  const double l0 = lambda[r], l1 = lambda[r + 1], d0 = delta[r], d1 = delta[r + 1];
  const double t1 = l0 - (v[0] * d0 + v[1] * d1), t2 = l1 - (v[1] * d0 + v[2] * d1);
  if (t1 * t1 + t2 * t2 <= bound2) return {t1, t2, 0};
  const double* w = data.w + r * s + r;
  const double q1 = d0 - (w[0] * l0 + w[1] * l1), q2 = d1 - (w[1] * l0 + w[s + 1] * l1);
  const double g1 = -(b.vx * q1 + b.vy * q2), g2 = b.vy * q1 - b.vx * q2;
  double slip = b.slip, e1 = b.high + slip, e2 = b.low + slip;
  if (!(slip >= 0)) return exact(data, k, b, lambda, delta, g1, g2);
  for (int step_count = 0;; ++step_count) {
    const double p1 = g1 * e2, p2 = g2 * e1, m = e1 * e2;
    const double f = p1 * p1 + p2 * p2 - bound2 * m * m, df = 2 * (g1 * p1 + g2 * p2 - bound2 * m * (e1 + e2));
    const double step = f / df;
    slip -= step;
    e1 -= step;
    e2 -= step;
    if (!(slip >= 0) || step_count == 4) return exact(data, k, b, lambda, delta, g1, g2);
    if (size(step) <= slip_step * e2) break;
  }
  const double p1 = g1 * e2, p2 = g2 * e1, scale = bound / __builtin_sqrt(p1 * p1 + p2 * p2);
  if (!(size(scale * e1 * e2 - 1) < 1e-2)) return exact(data, k, b, lambda, delta, g1, g2);
  b.slip = slip;
  return {(b.vx * p1 - b.vy * p2) * scale, (b.vy * p1 + b.vx * p2) * scale, 0};
}

inline Move move_block(const SweepData& data, int k, LocalBlock& b, double* lambda, const double* delta) {
  double* l = lambda + b.row;
  if (b.law == LawKind::box) return move_box(b, l, delta[b.row]);
  const bool friction = b.law == LawKind::friction;
  const Three next = friction ? next_friction(data, k, b, lambda, delta) : next_patch(data, k, b, lambda, delta);
  const Move m = {{next.n - l[0], next.t1 - l[1], friction ? next.t2 - l[2] : 0}, friction ? 3 : 2};
  if (m.d[0] == 0 && m.d[1] == 0 && m.d[2] == 0) return {{}, 0};
  l[0] = next.n;
  l[1] = next.t1;
  if (friction) l[2] = next.t2;
  return m;
}

// --- products with W -------------------------------------------------------------------------------------------------

// y[0..n) += sum of so many rows, each times its own d; n is a multiple of W.
template <int rows>
inline __attribute__((always_inline)) void add_rows(double* y, const double* const* w, const double* d, long n) {
  const double* row[rows];
  V by[rows];
#pragma GCC unroll 8
  for (int i = 0; i < rows; ++i) {
    row[i] = w[i];
    by[i] = V{} + d[i];
  }
  const auto vector = [&](long j) __attribute__((always_inline)) {
    V x = load(y + j);
#pragma GCC unroll 8
    for (int i = 0; i < rows; ++i) x += load(row[i] + j) * by[i];
    store(y + j, x);
  };
  constexpr int together = rows < 4 ? 4 : 1;
  long j = 0;
  for (; j + together * W <= n; j += together * W) {
#pragma GCC unroll 4
    for (int u = 0; u < together; ++u) vector(j + u * W);
  }
  for (; j < n; j += W) vector(j);
}

double sweep(const SweepData& data, double* lambda, double* delta) {
  const long s = data.stride;
  double most = 0;
  for (int k = 0; k < data.block_count; ++k) {
    LocalBlock& b = data.blocks[k];
    const Move m = move_block(data, k, b, lambda, delta);
    if (m.rows == 0) continue;
    const double* w = data.w + b.row * s;
    const double* row[3] = {w, w + s, w + 2 * s};
    if (m.rows == 1) {
      add_rows<1>(delta, row, m.d, s);
      most = larger(most, size(m.d[0]) * (w[b.row] + b.compliance));
      continue;
    }
    if (m.rows == 3) add_rows<3>(delta, row, m.d, s);
    else add_rows<2>(delta, row, m.d, s);
    for (int i = 0; i < m.rows; ++i) most = larger(most, size(m.d[i]) * row[i][b.row + i]);
  }
  return most;
}

void combine(double* y, const double* a, long stride, const double* c, int rows, int n) {
  constexpr int group = W < 4 ? 4 : W;  // rows processed together: as many as registers allow
  const double* row[group];
  double d[group];
  int count = 0;
  for (int k = 0; k < rows; ++k) {
    if (c[k] == 0) continue;
    row[count] = a + k * stride;
    d[count++] = c[k];
    if (count < group) continue;
    add_rows<group>(y, row, d, n);
    count = 0;
  }
  for (int k = 0; k < count; ++k) add_rows<1>(y, row + k, d + k, n);
}

}  // namespace

extern const SweepKernels sweep_table;
const SweepKernels sweep_table = {sweep, combine};

}  // namespace insula::KERNEL_NAME
