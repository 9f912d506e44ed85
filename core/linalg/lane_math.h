// SPDX-License-Identifier: GPL-3.0-or-later
// Functions of a double or of a vector of doubles, so that a formula is written once for both. They are static, and
// functions made of them should be static too. Code compiled for one instruction set must never replace that of
// another.
#pragma once
#include <cmath>
#include <type_traits>

namespace insula {

template <class V>
static inline V most(V a, V b) {
  return a > b ? a : b;
}

template <class V>
static inline V root(V v) {
  if constexpr (std::is_floating_point_v<V>) {
    return std::sqrt(v);
  } else {
    for (unsigned i = 0; i < sizeof v / sizeof v[0]; ++i) v[i] = __builtin_sqrt(v[i]);
    return v;
  }
}

template <class V>
static inline V dot(const V (&a)[3], const V (&b)[3]) {
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

template <class V>
static inline void cross(const V (&a)[3], const V (&b)[3], V (&out)[3]) {
  for (int i = 0; i < 3; ++i) out[i] = a[(i + 1) % 3] * b[(i + 2) % 3] - a[(i + 2) % 3] * b[(i + 1) % 3];
}

/// The nearest integer, for |x| < 2^51.
template <class V>
static inline V whole(V x) {
  constexpr double shift = 6755399441055744.0;  // 1.5 * 2^52: its last digit is 1
  return (x + shift) - shift;
}

/// The angle of the point (x, y), rad in [-pi, pi], with an error of about 3e-16; 0 for the origin. Up to 0.66 it is a
/// rational approximation of the arc tangent (Moshier, Methods and Programs for Mathematical Functions, 1989). Beyond
/// that the difference to pi/4 is approximated.
template <class V>
static inline V direction(V y, V x) {
  constexpr double quarter = 0.78539816339744830962;
  const V ax = x < 0 ? -x : x, ay = y < 0 ? -y : y, large = ax > ay ? ax : ay, small = ax > ay ? ay : ax;
  const auto steep = small > 0.66 * large;
  const V up = steep ? small - large : small, down = steep ? small + large : large;
  const V t = up / (down > 0 ? down : V{} + 1.0), z = t * t;
  const V p = (((-8.750608600031904122785e-1 * z - 1.615753718733365076637e1) * z - 7.500855792314704667340e1) * z -
               1.228866684490136173410e2) *
                  z -
              6.485021904942025371773e1;
  const V q = ((((z + 2.485846490142306297962e1) * z + 1.650270098316988542046e2) * z + 4.328810604912902668951e2) * z +
               4.853903996359136964868e2) *
                  z +
              1.945506571482613964425e2;
  V angle = t + t * z * p / q;
  angle = steep ? angle + quarter : angle;
  angle = ay > ax ? 2 * quarter - angle : angle;
  angle = x < 0 ? 4 * quarter - angle : angle;
  return y < 0 ? -angle : angle;
}

}  // namespace insula
