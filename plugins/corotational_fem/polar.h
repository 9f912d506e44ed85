// SPDX-License-Identifier: GPL-3.0-or-later
// Rotation of a deformation gradient F = R S, warm-started: Newton on the rotation that makes R^T F symmetric.
// With S = sym(R^T F) and w the axial vector of R^T F - (R^T F)^T, one step turns R by (tr(S) I - S)^-1 w; it converges
// quadratically, so one or two steps follow a body in motion. The maximum of tr(R^T F) over rotations is kept for
// inverted elements too: the least principal stretch is then the negative one.
#pragma once
#include <Eigen/SVD>
#include <cmath>

#include "core/base/math.h"

namespace insula {

/// The rotation nearest to F by singular values; a reflection goes into the least stretch.
inline Mat3 rotation_by_svd(const Mat3& f) {
  const Eigen::JacobiSVD<Mat3> svd(f, Eigen::ComputeFullU | Eigen::ComputeFullV);
  Mat3 u = svd.matrixU();
  const Mat3 v = svd.matrixV();
  if ((u * v.transpose()).determinant() < 0) u.col(2) = -u.col(2);
  return u * v.transpose();
}

/// Updates q (a guess) to the rotation of f and returns it as a matrix.
inline Mat3 polar_rotation(const Mat3& f, Quat& q) {
  Mat3 r = q.toRotationMatrix();
  for (int k = 0; k < 12; ++k) {
    const Mat3 a = r.transpose().lazyProduct(f);
    const double w0 = a(2, 1) - a(1, 2), w1 = a(0, 2) - a(2, 0), w2 = a(1, 0) - a(0, 1);
    const double t = a(0, 0) + a(1, 1) + a(2, 2);
    const double xx = t - a(0, 0), yy = t - a(1, 1), zz = t - a(2, 2);
    const double xy = -0.5 * (a(0, 1) + a(1, 0)), xz = -0.5 * (a(0, 2) + a(2, 0)), yz = -0.5 * (a(1, 2) + a(2, 1));
    // Inverse of the symmetric 3x3 matrix by cofactors; it must be positive definite at a maximum.
    const double c00 = yy * zz - yz * yz, c01 = xz * yz - xy * zz, c02 = xy * yz - xz * yy;
    const double det = xx * c00 + xy * c01 + xz * c02;
    const double scale = std::abs(t) + std::abs(xy) + std::abs(xz) + std::abs(yz);
    if (!(xx > 0) || !(xx * yy - xy * xy > 0) || !(det > 1e-9 * scale * scale * scale)) break;
    const double half = 0.5 / det;
    const double c11 = xx * zz - xz * xz, c12 = xy * xz - xx * yz, c22 = xx * yy - xy * xy;
    const double d0 = half * (c00 * w0 + c01 * w1 + c02 * w2), d1 = half * (c01 * w0 + c11 * w1 + c12 * w2),
                 d2 = half * (c02 * w0 + c12 * w1 + c22 * w2);
    const double half_size2 = d0 * d0 + d1 * d1 + d2 * d2;
    if (half_size2 > 0.25) break;  // far off: start from the singular values
    q = (q * Quat(1.0, d0, d1, d2)).normalized();
    r = q.toRotationMatrix();
    if (half_size2 < 2.5e-15) return r;  // the next correction would be of the order of its cube
  }
  r = rotation_by_svd(f);
  q = Quat(r).normalized();
  return r;
}

}  // namespace insula
