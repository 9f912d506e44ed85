// SPDX-License-Identifier: GPL-3.0-or-later
// The rotation nearest to a matrix, followed from step to step (Mueller, Bender, Chentanez, Macklin 2016, "A robust
// method to extract the rotational part of deformations"). R is rotated by sum r_i x a_i / |sum r_i . a_i| until its
// columns r_i are parallel to those of the matrix, a_i.
#pragma once
#include <cmath>

#include "core/base/math.h"

namespace insula {

/// Rotates the guess q to the nearest rotation and returns it as a matrix. Never fails. A remaining error after a few
/// iterations is removed in the next step.
inline Mat3 nearest_rotation(const Mat3& a, Quat& q) {
  constexpr double enough = 1e-5;  // rad
  Mat3 r = q.toRotationMatrix();
  for (int k = 0; k < 8; ++k) {
    Vec3 moment = Vec3::Zero();
    double along = 0;
    for (int c = 0; c < 3; ++c) {
      moment += r.col(c).cross(a.col(c));
      along += r.col(c).dot(a.col(c));
    }
    const double size = std::abs(along);
    if (!(size > 0)) break;
    const Vec3 turn = moment / size;
    // The tangent of half the angle replaces its sine. The difference is negligible for a small angle. For a large one
    // the next iteration corrects it.
    q = (Quat(1, 0.5 * turn.x(), 0.5 * turn.y(), 0.5 * turn.z()) * q).normalized();
    r = q.toRotationMatrix();
    if (turn.squaredNorm() < enough * enough) break;
  }
  return r;
}

}  // namespace insula
