// SPDX-License-Identifier: GPL-3.0-or-later
// Data exchanged between a driver's thread and the servo, in the device's frame.
#pragma once
#include <cmath>
#include <cstdint>

#include "core/base/math.h"

namespace insula {

/// One measurement. Metres, radians, seconds; frame of the device as its maker defines it.
struct DeviceSample {
  std::int64_t time_ns = 0;  ///< monotonic clock; set by StreamedDevice
  bool valid = false;
  Pose pose;
  Vec3 v = Vec3::Zero();
  Vec3 w = Vec3::Zero();
  bool has_w = false;  ///< w was measured; otherwise it is computed from the poses
  bool button1 = false;
  bool button2 = false;
};

/// The force and torque for the device, in its own frame.
struct DeviceForce {
  std::int64_t time_ns = 0;
  Vec3 force_N = Vec3::Zero();
  Vec3 torque_Nm = Vec3::Zero();
};

/// A hand is within two metres of its device and slower than 20 m/s; a quaternion is nearly of length 1.
inline bool plausible(const DeviceSample& s) noexcept {
  return s.pose.p.allFinite() && s.pose.q.coeffs().allFinite() && s.v.allFinite() && s.w.allFinite() &&
         s.pose.p.cwiseAbs().maxCoeff() <= 2 && s.v.cwiseAbs().maxCoeff() <= 20 && s.w.cwiseAbs().maxCoeff() <= 200 &&
         std::abs(s.pose.q.squaredNorm() - 1) < 0.02;
}

}  // namespace insula
