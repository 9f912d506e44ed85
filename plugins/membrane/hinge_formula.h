// SPDX-License-Identifier: GPL-3.0-or-later
// Shape, angle and gradient of a hinge (hinge.h), for one hinge or for a vector of them.
#pragma once
#include "core/linalg/lane_math.h"

namespace insula {

template <class V>
struct HingeShape {
  V e[3], a[3], b[3];  // edge, apexes from the edge's first end
  V n1[3], n2[3];      // doubled area vectors
  V e2, size1, size2, along1, along2;
};

/// x: coordinates of the four nodes, one after the other.
template <class V>
static inline HingeShape<V> hinge_shape(const V (&x)[12], V least1, V least2) {
  const V nothing = V{} + 1e-300;
  HingeShape<V> s;
  for (int c = 0; c < 3; ++c) s.e[c] = x[3 + c] - x[c], s.a[c] = x[6 + c] - x[c], s.b[c] = x[9 + c] - x[c];
  cross(s.e, s.a, s.n1);
  cross(s.b, s.e, s.n2);
  s.e2 = most(dot(s.e, s.e), nothing);
  s.size1 = most(most(dot(s.n1, s.n1), least1), nothing);
  s.size2 = most(most(dot(s.n2, s.n2), least2), nothing);
  s.along1 = dot(s.e, s.a) / s.e2;
  s.along2 = dot(s.e, s.b) / s.e2;
  return s;
}

template <class V>
static inline V angle_of(const HingeShape<V>& s) {
  V across[3];
  cross(s.n2, s.n1, across);
  return direction(V(dot(s.e, across) / root(s.e2)), dot(s.n1, s.n2));
}

template <class V>
static inline void gradient_of(const HingeShape<V>& s, V (&g)[12]) {
  const V length = root(s.e2), k1 = length / s.size1, k2 = length / s.size2;
  for (int c = 0; c < 3; ++c) {
    const V a = k1 * s.n1[c], b = k2 * s.n2[c], end = -s.along1 * a - s.along2 * b;
    g[c] = -(a + b + end);
    g[3 + c] = end;
    g[6 + c] = a;
    g[9 + c] = b;
  }
}

/// `angle` plus the multiple of a full turn that brings it nearest to `before`.
template <class V>
static inline V unwrapped(V angle, V before) {
  constexpr double turn = 6.28318530717958647693;
  return angle + turn * whole(V((before - angle) * (1 / turn)));
}

}  // namespace insula
