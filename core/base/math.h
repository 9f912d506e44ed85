// SPDX-License-Identifier: GPL-3.0-or-later
// Common names of linear algebra. All quantities are in SI units and in the scene frame unless stated otherwise.
#pragma once
#include <Eigen/Core>
#include <Eigen/Geometry>

namespace insula {

using Vec3 = Eigen::Vector3d;
using Vec6 = Eigen::Matrix<double, 6, 1>;
using Mat3 = Eigen::Matrix3d;
using Mat6 = Eigen::Matrix<double, 6, 6>;
using Quat = Eigen::Quaterniond;
using VecX = Eigen::VectorXd;
using MatX = Eigen::MatrixXd;

/// Rigid pose: p in metres, q unit quaternion; maps body coordinates x to p + q x.
struct Pose {
  Vec3 p = Vec3::Zero();
  Quat q = Quat::Identity();

  Vec3 apply(const Vec3& local) const { return p + q * local; }
};

/// The matrix [a]x with [a]x b = a x b.
inline Mat3 skew(const Vec3& a) {
  Mat3 m;
  m << 0, -a.z(), a.y(), a.z(), 0, -a.x(), -a.y(), a.x(), 0;
  return m;
}

/// Rotation vector (axis times angle, rad, angle in [0, pi]) of a unit quaternion.
Vec3 rotation_vector(const Quat& q);
/// Inverse of rotation_vector.
Quat from_rotation_vector(const Vec3& r);
/// Six-component displacement (metres, then rotation vector in the scene frame) that takes pose a to pose b.
Vec6 displacement(const Pose& a, const Pose& b);
/// The pose that is reached from a by that displacement.
Pose displaced(const Pose& a, const Vec6& d);

}  // namespace insula
