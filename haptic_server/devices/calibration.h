// SPDX-License-Identifier: GPL-3.0-or-later
// Orientation of a device in front of its user: axes, rest pose, scale. Stored in the user's configuration folder.
#pragma once
#include <filesystem>
#include <string>

#include "core/base/math.h"

namespace insula {

/// Maps the device's frame to that of the person in front of the screen (x right, y away, z up):
///   p = scale * axes * (p_device - rest.p)
///   q = axes * q_device * rest.q^-1 * axes^T
/// A device at its rest pose then reads as the identity.
struct DeviceCalibration {
  Mat3 axes = Mat3::Identity();  ///< a rotation; its rows are the person's axes in the device's frame
  Pose rest;                     ///< device's frame
  double scale = 1;              ///< motion of the tool over motion of the hand

  static constexpr double min_scale = 0.05, largest_scale = 5;
};

/// Reason why a calibration is not valid, or empty. Valid: all numbers finite, axes a rotation, rest pose within 2 m,
/// scale within its range.
std::string calibration_error(const DeviceCalibration& calibration);

/// $XDG_CONFIG_HOME/insula/devices or ~/.config/insula/devices.
std::filesystem::path calibration_folder();
/// The file of a device, such as "touch:Left Device" or "haply left" (the arm of the left hand).
std::filesystem::path calibration_file(const std::string& device);
/// The device's calibration, or `fallback` if there is no file. Throws InputError, with the file's name, if it is not
/// valid.
DeviceCalibration load_calibration(const std::string& device, const DeviceCalibration& fallback);
/// Throws InputError if the calibration is not valid or the file cannot be written. Returns the file.
std::filesystem::path save_calibration(const std::string& device, const DeviceCalibration& calibration);

}  // namespace insula
