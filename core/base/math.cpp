// SPDX-License-Identifier: GPL-3.0-or-later
// Rotations as vectors and quaternions.
#include "core/base/math.h"

#include <cmath>

namespace insula {

Vec3 rotation_vector(const Quat& q) {
  // Of q and -q, the one with the smaller rotation angle is used.
  const double sign = q.w() < 0 ? -1.0 : 1.0;
  const Vec3 v = sign * q.vec();
  const double s = v.norm();
  const double w = sign * q.w();
  if (s < 1e-12) return 2.0 * v;
  return (2.0 * std::atan2(s, w) / s) * v;
}

Quat from_rotation_vector(const Vec3& r) {
  const double angle = r.norm();
  const double half = 0.5 * angle;
  const double k = angle < 1e-12 ? 0.5 : std::sin(half) / angle;
  return Quat(std::cos(half), k * r.x(), k * r.y(), k * r.z()).normalized();
}

Vec6 displacement(const Pose& a, const Pose& b) {
  Vec6 d;
  d.head<3>() = b.p - a.p;
  d.tail<3>() = rotation_vector(b.q * a.q.conjugate());
  return d;
}

Pose displaced(const Pose& a, const Vec6& d) {
  return {a.p + d.head<3>(), (from_rotation_vector(d.tail<3>()) * a.q).normalized()};
}

}  // namespace insula
