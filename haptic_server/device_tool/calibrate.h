// SPDX-License-Identifier: GPL-3.0-or-later
// The calibration that belongs to four places of a device.
#pragma once
#include "haptic_server/devices/calibration.h"

namespace insula {

/// `right`, `away`, `up`: where the device was after the hand had moved so from `rest`; device's frame, metres. Fits a
/// rotation to all three. Throws InputError for a way shorter than 2 cm, or ways that do not stand at right angles.
DeviceCalibration fit_calibration(const Pose& rest, const Vec3& right, const Vec3& away, const Vec3& up, double scale);

}  // namespace insula
