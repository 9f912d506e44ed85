// SPDX-License-Identifier: GPL-3.0-or-later
// Deformation and stress of a wall's triangle (stretch.h), for one triangle or for a vector of them.
#pragma once
#include "core/linalg/lane_math.h"

namespace insula {

/// A triangle that is compressed below this share of its area keeps the direction of its stress.
inline constexpr double min_area = 1e-3;

template <class V>
struct StretchOf {
  V f0[3], f1[3];   // columns of F
  V c00, c01, c11;  // F^T F
  V det, trace;     // of S
  V i00, i01, i11;  // S^-1
};

/// u, v: the triangle's second and third corner from the first, m. b: rest gradients of all three, of which the last
/// two are used, 1/m. Differences stay accurate far from the origin.
template <class V>
static inline StretchOf<V> stretch_of(const V (&u)[3], const V (&v)[3], const V (&b)[3][2]) {
  StretchOf<V> s;
  for (int c = 0; c < 3; ++c) {
    s.f0[c] = u[c] * b[1][0] + v[c] * b[2][0];
    s.f1[c] = u[c] * b[1][1] + v[c] * b[2][1];
  }
  s.c00 = dot(s.f0, s.f0);
  s.c01 = dot(s.f0, s.f1);
  s.c11 = dot(s.f1, s.f1);
  V n[3];
  cross(s.f0, s.f1, n);
  s.det = root(dot(n, n));
  s.trace = root(V(s.c00 + s.c11 + 2 * s.det));
  const V scale = 1 / (most(s.trace, V{} + 1e-9) * most(s.det, V{} + min_area));
  s.i00 = scale * (s.c11 + s.det);
  s.i01 = -scale * s.c01;
  s.i11 = scale * (s.c00 + s.det);
  return s;
}

template <class V>
struct StressOf {
  V z, d, o, h;     // of the prestrain: z, D, D : S
  V g00, g01, g11;  // G
  V p0[3], p1[3];   // columns of F G
};

template <class V>
static inline StressOf<V> stress_of(const StretchOf<V>& s, V mu, V lambda, const V (&pre)[3]) {
  const V trace = most(s.trace, V{} + 1e-9);
  StressOf<V> t;
  t.z = (mu + lambda) * (pre[0] + pre[2]);
  t.d = mu * (pre[0] - pre[2]);
  t.o = 2 * mu * pre[1];
  t.h = (t.d * (s.c00 - s.c11) + 2 * t.o * s.c01) / trace;
  const V k = lambda * (s.trace - 2) + t.z - 2 * mu - t.h / trace;
  t.g00 = 2 * (mu + t.d / trace) + k * s.i00;
  t.g01 = 2 * t.o / trace + k * s.i01;
  t.g11 = 2 * (mu - t.d / trace) + k * s.i11;
  for (int c = 0; c < 3; ++c) {
    t.p0[c] = s.f0[c] * t.g00 + s.f1[c] * t.g01;
    t.p1[c] = s.f0[c] * t.g01 + s.f1[c] * t.g11;
  }
  return t;
}

}  // namespace insula
