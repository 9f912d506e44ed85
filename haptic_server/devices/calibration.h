// SPDX-License-Identifier: GPL-3.0-or-later
// How a device stands in front of the person who holds it: axes, rest pose, scale. Kept in the user's configuration
// folder.
#pragma once
#include <filesystem>
#include <string>

#include "core/base/math.h"

namespace insula {

/// From the device's frame to that of the person in front of the screen (x right, y away, z up):
///   p = scale * axes * (p_device - rest.p)
///   q = axes * q_device * rest.q^-1 * axes^T
/// so that a device held at its rest pose reads as the identity.
struct DeviceCalibration {
  Mat3 axes = Mat3::Identity();  ///< a rotation; its rows are the person's axes in the device's frame
  Pose rest;                     ///< device's frame
  double scale = 1;              ///< movement of the tool over movement of the hand

  static constexpr double min_scale = 0.05, largest_scale = 5;
};

/// Empty when usable, else what is wrong: everything finite, axes a rotation, rest pose within 2 m, scale within its
/// range.
std::string calibration_error(const DeviceCalibration& calibration);

/// $XDG_CONFIG_HOME/insula/devices or ~/.config/insula/devices.
std::filesystem::path calibration_folder();
/// The file of a device, such as "touch:Left Device" or "haply left" (the one that the left hand gets).
std::filesystem::path calibration_file(const std::string& device);
/// The device's own calibration, or `fallback` where there is no file. Throws InputError, with the file's name, for one
/// that cannot be used.
DeviceCalibration load_calibration(const std::string& device, const DeviceCalibration& fallback);
/// Throws InputError for a calibration that is not usable or a file that cannot be written. Returns the file.
std::filesystem::path save_calibration(const std::string& device, const DeviceCalibration& calibration);

}  // namespace insula
