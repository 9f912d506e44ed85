// SPDX-License-Identifier: GPL-3.0-or-later
// Rotations of deformation gradients F = R S, a vector of them at once, for loops compiled once per instruction set.
// polar.h handles those that are not found here.
#pragma once
#include "core/linalg/lane_bits.h"
#include "core/linalg/lane_math.h"

namespace insula::KERNEL_NAME {

template <class V>
static inline V absolute(V v) {
  return v < 0 ? -v : v;
}

/// Rows of R, r[3 i + j], of a unit quaternion.
template <class V>
static inline void matrix_of(const V q[4], V r[9]) {
  const V x2 = q[1] + q[1], y2 = q[2] + q[2], z2 = q[3] + q[3];
  const V wx = x2 * q[0], wy = y2 * q[0], wz = z2 * q[0], xx = x2 * q[1], xy = y2 * q[1], xz = z2 * q[1];
  const V yy = y2 * q[2], yz = z2 * q[2], zz = z2 * q[3];
  r[0] = 1 - (yy + zz), r[1] = xy - wz, r[2] = xz + wy;
  r[3] = xy + wz, r[4] = 1 - (xx + zz), r[5] = yz - wx;
  r[6] = xz - wy, r[7] = yz + wx, r[8] = 1 - (xx + yy);
}

/// Newton's method for the rotation that makes A = R^T F symmetric. With S = sym(A) and w the axial vector of A - A^T,
/// one step rotates R by (tr(S) I - S)^-1 w. The tangent of half the angle is half of that vector. The convergence is
/// cubic: an error d becomes one of the order d^3. Converged lanes stay as they are. If S is not a maximum of tr(R^T
/// F), or the angle is large, the lane fails and the caller uses singular values.
template <class V, class M = decltype(V{} == V{})>
static inline M rotation_by_newton(const V f[9], V q[4], V r[9]) {
  constexpr double close = 1e-12, far = 0.25;  // of the squared tangent of half an angle
  M active = (V{} == V{}), failed = (V{} != V{});
  matrix_of(q, r);
  for (int k = 0; k < 12; ++k) {
    V a[9];
    for (int i = 0; i < 3; ++i)
      for (int j = 0; j < 3; ++j) a[3 * i + j] = r[i] * f[j] + r[3 + i] * f[3 + j] + r[6 + i] * f[6 + j];
    const V w0 = a[7] - a[5], w1 = a[2] - a[6], w2 = a[3] - a[1];
    const V t = a[0] + a[4] + a[8], xx = t - a[0], yy = t - a[4], zz = t - a[8];
    const V xy = -0.5 * (a[1] + a[3]), xz = -0.5 * (a[2] + a[6]), yz = -0.5 * (a[5] + a[7]);
    const V c00 = yy * zz - yz * yz, c01 = xz * yz - xy * zz, c02 = xy * yz - xz * yy;
    const V c11 = xx * zz - xz * xz, c12 = xy * xz - xx * yz, c22 = xx * yy - xy * xy;
    const V det = xx * c00 + xy * c01 + xz * c02;
    const V size = absolute(t) + absolute(xy) + absolute(xz) + absolute(yz);
    const M good = (xx > 0) & (c22 > 0) & (det > 1e-9 * size * size * size);
    const V half = 0.5 / det;
    const V d0 = half * (c00 * w0 + c01 * w1 + c02 * w2), d1 = half * (c01 * w0 + c11 * w1 + c12 * w2),
            d2 = half * (c02 * w0 + c12 * w1 + c22 * w2);
    const V size2 = d0 * d0 + d1 * d1 + d2 * d2;
    const M usable = good & (size2 <= far);
    failed |= active & ~usable;
    active &= usable;
    const V n0 = q[0] - q[1] * d0 - q[2] * d1 - q[3] * d2, n1 = q[1] + q[0] * d0 + q[2] * d2 - q[3] * d1;
    const V n2 = q[2] + q[0] * d1 + q[3] * d0 - q[1] * d2, n3 = q[3] + q[0] * d2 + q[1] * d1 - q[2] * d0;
    const V scale = 1 / root(n0 * n0 + n1 * n1 + n2 * n2 + n3 * n3);
    q[0] = active ? n0 * scale : q[0];
    q[1] = active ? n1 * scale : q[1];
    q[2] = active ? n2 * scale : q[2];
    q[3] = active ? n3 * scale : q[3];
    matrix_of(q, r);
    active &= (size2 >= close);
    if (lane_bits(active) == 0) return failed;
  }
  return failed | active;
}

}  // namespace insula::KERNEL_NAME
