// SPDX-License-Identifier: GPL-3.0-or-later
// Rotation of a deformation gradient F = R S where Newton's method (newton_rotation.h) does not find it: the maximum of
// tr(R^T F) over rotations. For an inverted element the smallest principal stretch is negative.
#pragma once
#include <Eigen/SVD>

#include "core/base/math.h"

namespace insula {

/// The rotation nearest to F by singular values. A reflection goes into the smallest stretch.
inline Mat3 rotation_by_svd(const Mat3& f) {
  const Eigen::JacobiSVD<Mat3> svd(f, Eigen::ComputeFullU | Eigen::ComputeFullV);
  Mat3 u = svd.matrixU();
  const Mat3 v = svd.matrixV();
  if ((u * v.transpose()).determinant() < 0) u.col(2) = -u.col(2);
  return u * v.transpose();
}

}  // namespace insula
