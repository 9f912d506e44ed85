// SPDX-License-Identifier: GPL-3.0-or-later
// Calibration from four positions of a device.
#pragma once
#include "haptic_server/devices/calibration.h"

namespace insula {

/// `right`, `away`, `up`: positions of the device after the hand has moved in that direction from `rest`; device's
/// frame, m. Fits a rotation to all three displacements. Throws InputError if one is shorter than 2 cm, or if they are
/// not at right angles.
DeviceCalibration fit_calibration(const Pose& rest, const Vec3& right, const Vec3& away, const Vec3& up, double scale);

}  // namespace insula
