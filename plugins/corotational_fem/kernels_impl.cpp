// SPDX-License-Identifier: GPL-3.0-or-later
// Compiled once per instruction set: KERNEL_NAME, KERNEL_BYTES (of a vector). The formulas are in corotational_fem.cpp.
#include <utility>

#include "core/linalg/lane_bits.h"
#include "core/linalg/lane_math.h"
#include "plugins/corotational_fem/element_batch.h"
#include "plugins/corotational_fem/newton_rotation.h"

namespace insula::KERNEL_NAME {
namespace {

constexpr int W = KERNEL_BYTES / 8;  // doubles a vector
typedef double V __attribute__((vector_size(W * 8)));
typedef double VAnywhere __attribute__((vector_size(W * 8), aligned(8), may_alias));  // in arrays of doubles

inline V load(const double* p) { return *reinterpret_cast<const VAnywhere*>(p); }
inline void store(double* p, V v) { *reinterpret_cast<VAnywhere*>(p) = v; }
inline V all(double x) { return V{} + x; }

unsigned rotate(const ElementBatch& e, const double* x, ElementWork& work) {
  unsigned out = 0;
  for (int l = 0; l < batch_lanes; l += W) {
    V f[9] = {};
    double p[12][W];
    for (int k = 0; k < 4; ++k)
      for (int i = 0; i < W; ++i)
        for (int c = 0; c < 3; ++c) p[3 * k + c][i] = x[3 * e.node[k][l + i] + c];
    for (int k = 0; k < 3; ++k)
      for (int c = 0; c < 3; ++c) {
        const V d = load(p[3 * k + 3 + c]) -
                    load(p[c]);  // differences first, so that accuracy does not depend on the distance from the origin
        for (int j = 0; j < 3; ++j) f[3 * c + j] += d * load(e.b[k][j] + l);
      }
    V q[4], r[9];
    for (int k = 0; k < 4; ++k) q[k] = load(e.q[k] + l);
    out |= lane_bits(rotation_by_newton<V>(f, q, r)) << l;
    for (int k = 0; k < 9; ++k) {
      store(work.f[k] + l, f[k]);
      store(work.r[k] + l, r[k]);
    }
    for (int k = 0; k < 4; ++k) store(work.q[k] + l, q[k]);
  }
  return out;
}

struct Strain {
  V e00, e11, e22, e01, e02, e12, trace, norm2;
};

inline Strain strain_of(ElementWork& work, int l) {
  V f[9], r[9];
  for (int k = 0; k < 9; ++k) f[k] = load(work.f[k] + l), r[k] = load(work.r[k] + l);
  const auto at = [&](int i, int j) { return r[i] * f[j] + r[3 + i] * f[3 + j] + r[6 + i] * f[6 + j]; };
  Strain e;
  e.e00 = at(0, 0) - 1, e.e11 = at(1, 1) - 1, e.e22 = at(2, 2) - 1;
  e.e01 = 0.5 * (at(0, 1) + at(1, 0)), e.e02 = 0.5 * (at(0, 2) + at(2, 0)), e.e12 = 0.5 * (at(1, 2) + at(2, 1));
  e.trace = e.e00 + e.e11 + e.e22;
  e.norm2 = e.e00 * e.e00 + e.e11 * e.e11 + e.e22 * e.e22 + 2 * (e.e01 * e.e01 + e.e02 * e.e02 + e.e12 * e.e12);
  store(work.s[0] + l, 1 + e.e00);
  store(work.s[1] + l, 1 + e.e11);
  store(work.s[2] + l, 1 + e.e22);
  store(work.s[3] + l, e.e01);
  store(work.s[4] + l, e.e02);
  store(work.s[5] + l, e.e12);
  return e;
}

unsigned force(const ElementBatch& b, const ElementMaterial& m, ElementWork& work, double* force) {
  unsigned out = 0;
  for (int l = 0; l < batch_lanes; l += W) {
    const Strain e = strain_of(work, l);
    out |= lane_bits(e.norm2 > m.far2) << l;
    const V volume = load(b.volume + l), two = 2 * m.mu * volume, all_round = m.lambda * volume * e.trace;
    V t00 = two * e.e00 + all_round, t11 = two * e.e11 + all_round, t22 = two * e.e22 + all_round;
    const V t01 = two * e.e01, t02 = two * e.e02, t12 = two * e.e12;
    if (m.swelling_stress != 0) {  // apart, so that tissue that does not swell keeps its bits
      const V swelling = m.swelling_stress * volume;
      t00 -= swelling, t11 -= swelling, t22 -= swelling;
    }
    for (int c = 0; c < 3; ++c) {
      const V r0 = load(work.r[3 * c] + l), r1 = load(work.r[3 * c + 1] + l), r2 = load(work.r[3 * c + 2] + l);
      const V p0 = r0 * t00 + r1 * t01 + r2 * t02, p1 = r0 * t01 + r1 * t11 + r2 * t12,
              p2 = r0 * t02 + r1 * t12 + r2 * t22;
      V sum = V{};
      for (int k = 0; k < 3; ++k) {
        const V g = p0 * load(b.b[k][0] + l) + p1 * load(b.b[k][1] + l) + p2 * load(b.b[k][2] + l);
        sum += g;
        store(work.out[3 * k + 3 + c] + l, g);
      }
      store(work.out[c] + l, -sum);
    }
  }
  for (int i = 0; i < b.count; ++i)
    for (int k = 0; k < 4; ++k) {
      double* to = force + 3 * b.node[k][i];
      for (int c = 0; c < 3; ++c) to[c] -= work.out[3 * k + c][i];
    }
  return out;
}

unsigned energy(const ElementBatch& b, const ElementMaterial& m, ElementWork& work) {
  unsigned out = 0;
  for (int l = 0; l < batch_lanes; l += W) {
    const Strain e = strain_of(work, l);
    out |= lane_bits(e.norm2 > m.far2) << l;
    store(work.out[0] + l,
          load(b.volume + l) * (m.mu * e.norm2 + 0.5 * m.lambda * e.trace * e.trace - m.swelling_stress * e.trace));
  }
  return out;
}

// One rotation of Jacobi's method on a symmetric matrix makes `off` zero. p and q are the entries beside it.
inline void turn(V& low, V& high, V& off, V& p, V& q, V* from, V* to) {
  const V apart = high - low, size = root(apart * apart + 4 * off * off);
  const V under = apart < 0 ? apart - size : apart + size;
  const V t = under != 0 ? 2 * off / under : V{};
  const V c = 1 / root(1 + t * t), s = t * c;
  low -= t * off;
  high += t * off;
  off = V{};
  const V p0 = p;
  p = c * p0 - s * q;
  q = s * p0 + c * q;
  for (int i = 0; i < 3; ++i) {
    const V v = from[i];
    from[i] = c * v - s * to[i];
    to[i] = s * v + c * to[i];
  }
}

// Stiffness of the element's spin, R (2 mu I - k (tr(S) I - S)^-1) R^T with k = 2 (2 mu - lambda tr e +
// swelling_stress), symmetric. With `positive`, negative eigenvalues are set to zero.
inline void spin_of(const ElementMaterial& m, const ElementWork& work, int l, bool positive, V g[6]) {
  V s[6], r[9];
  for (int k = 0; k < 6; ++k) s[k] = load(work.s[k] + l);
  for (int k = 0; k < 9; ++k) r[k] = load(work.r[k] + l);
  const V trace = s[0] + s[1] + s[2];
  V k = 2 * (2 * m.mu - m.lambda * (trace - 3));
  if (m.swelling_stress != 0) k += 2 * m.swelling_stress;
  V h[6];
  if (positive) {
    V axis[3][3] = {{all(1), V{}, V{}}, {V{}, all(1), V{}}, {V{}, V{}, all(1)}};  // columns of the eigenvectors
    for (int sweep = 0; sweep < 5; ++sweep) {
      turn(s[0], s[1], s[3], s[4], s[5], axis[0], axis[1]);
      turn(s[0], s[2], s[4], s[3], s[5], axis[0], axis[2]);
      turn(s[1], s[2], s[5], s[3], s[4], axis[1], axis[2]);
    }
    for (int i = 0; i < 6; ++i) h[i] = V{};
    for (int i = 0; i < 3; ++i) {
      const V gap = trace - s[i], resists = 2 * m.mu - k / gap;
      const V v = ((gap > 1e-9) & (resists > 0)) ? resists : V{};
      const V* a = axis[i];
      h[0] += v * a[0] * a[0], h[1] += v * a[1] * a[1], h[2] += v * a[2] * a[2];
      h[3] += v * a[0] * a[1], h[4] += v * a[0] * a[2], h[5] += v * a[1] * a[2];
    }
  } else {
    const V xx = trace - s[0], yy = trace - s[1], zz = trace - s[2], xy = -s[3], xz = -s[4], yz = -s[5];
    const V c00 = yy * zz - yz * yz, c01 = xz * yz - xy * zz, c02 = xy * yz - xz * yy;
    const V scale = k / (xx * c00 + xy * c01 + xz * c02);
    h[0] = 2 * m.mu - scale * c00, h[1] = 2 * m.mu - scale * (xx * zz - xz * xz),
    h[2] = 2 * m.mu - scale * (xx * yy - xy * xy);
    h[3] = -scale * c01, h[4] = -scale * c02, h[5] = -scale * (xy * xz - xx * yz);
  }
  V rh[3][3];
  for (int i = 0; i < 3; ++i) {
    const V* a = r + 3 * i;
    rh[i][0] = a[0] * h[0] + a[1] * h[3] + a[2] * h[4];
    rh[i][1] = a[0] * h[3] + a[1] * h[1] + a[2] * h[5];
    rh[i][2] = a[0] * h[4] + a[1] * h[5] + a[2] * h[2];
  }
  const auto at = [&](int i, int j) { return rh[i][0] * r[3 * j] + rh[i][1] * r[3 * j + 1] + rh[i][2] * r[3 * j + 2]; };
  g[0] = at(0, 0), g[1] = at(1, 1), g[2] = at(2, 2), g[3] = at(0, 1), g[4] = at(0, 2), g[5] = at(1, 2);
}

template <int s, int... l>
inline void exchange(V& a, V& b, std::integer_sequence<int, l...>) {
  const V low = __builtin_shufflevector(a, b, (l & s ? W + l - s : l)...);
  b = __builtin_shufflevector(a, b, (l & s ? W + l : l + s)...);
  a = low;
}

/// W vectors of W numbers, transposed.
inline void transpose(V* v) {
  constexpr auto lanes = std::make_integer_sequence<int, W>();
  for (int i = 0; i < W; i += 2) exchange<1>(v[i], v[i + 1], lanes);
  if constexpr (W > 2)
    for (int i = 0; i < W; ++i)
      if (!(i & 2)) exchange<2>(v[i], v[i + 2], lanes);
  if constexpr (W > 4)
    for (int i = 0; i < 4; ++i) exchange<4>(v[i], v[i + 4], lanes);
}

// Adds a block of nine numbers of each lane to its target.
inline void add_blocks(V v[9], const int* slot, int count, double* values) {
  double last[W];
  store(last, v[8]);
#pragma GCC unroll 4
  for (int part = 0; part < 8; part += W) transpose(v + part);
  for (int i = 0; i < count; ++i) {
    if (slot[i] < 0) continue;
    double* to = values + 9l * slot[i];
#pragma GCC unroll 4
    for (int part = 0; part < 8; part += W) store(to + part, load(to + part) + v[part + i]);
    to[8] += last[i];
  }
}

template <bool spin>
inline void stiffness_of(const ElementBatch& b, const ElementMaterial& m, const ElementWork& work, int l, double scale,
                         const V* turned, double* values) {
  const V weight = scale * load(b.volume + l), wm = weight * m.mu, wl = weight * m.lambda;
  V g[4][3];
  for (int c = 0; c < 3; ++c) {
    const V r0 = load(work.r[3 * c] + l), r1 = load(work.r[3 * c + 1] + l), r2 = load(work.r[3 * c + 2] + l);
    for (int k = 0; k < 3; ++k)
      g[k + 1][c] = r0 * load(b.b[k][0] + l) + r1 * load(b.b[k][1] + l) + r2 * load(b.b[k][2] + l);
    g[0][c] = -(g[1][c] + g[2][c] + g[3][c]);
  }
  const int count = b.count - l < W ? b.count - l : W;
  // K_ij = V (mu (g_i.g_j) I + mu g_j g_i^T + lambda g_i g_j^T), spin: skew(g_i)^T G skew(g_j)
  for (int i = 0, k = 0; i < 4; ++i) {
    V a[3], x[3][3];
    for (int c = 0; c < 3; ++c) a[c] = wm * g[i][c];
    if constexpr (spin) {  // rows of skew(g_i)^T G
      const V* p = g[i];
      const V gs[3][3] = {
          {turned[0], turned[3], turned[4]}, {turned[3], turned[1], turned[5]}, {turned[4], turned[5], turned[2]}};
      for (int c = 0; c < 3; ++c) {
        x[0][c] = weight * 0.5 * (gs[1][c] * p[2] - gs[2][c] * p[1]);
        x[1][c] = weight * 0.5 * (gs[2][c] * p[0] - gs[0][c] * p[2]);
        x[2][c] = weight * 0.5 * (gs[0][c] * p[1] - gs[1][c] * p[0]);
      }
    }
    for (int j = 0; j <= i; ++j, ++k) {
      V v[9];
      const V dot = a[0] * g[j][0] + a[1] * g[j][1] + a[2] * g[j][2];
      for (int c = 0; c < 3; ++c) {
        const V lj = wl * g[j][c];
        for (int r = 0; r < 3; ++r) v[3 * c + r] = a[c] * g[j][r] + lj * g[i][r];
        v[4 * c] += dot;
      }
      if constexpr (spin) {
        const V* p = g[j];
        for (int r = 0; r < 3; ++r) {
          v[r] += x[r][1] * p[2] - x[r][2] * p[1];
          v[3 + r] += x[r][2] * p[0] - x[r][0] * p[2];
          v[6 + r] += x[r][0] * p[1] - x[r][1] * p[0];
        }
      }
      add_blocks(v, b.slot[k] + l, count, values);
    }
  }
}

void stiffness(const ElementBatch& b, const ElementMaterial& m, const ElementWork& work, double scale, SpinTerm spin,
               double* values) {
  for (int l = 0; l < b.count; l += W) {
    if (spin == SpinTerm::none) {
      stiffness_of<false>(b, m, work, l, scale, nullptr, values);
    } else {
      V turned[6];
      spin_of(m, work, l, spin == SpinTerm::positive, turned);
      stiffness_of<true>(b, m, work, l, scale, turned, values);
    }
  }
}

}  // namespace

extern const ElementKernels element_table;
const ElementKernels element_table = {rotate, force, stiffness, energy};

}  // namespace insula::KERNEL_NAME
