// SPDX-License-Identifier: GPL-3.0-or-later
// The command `insula devices`: lists, shows, calibrates and tests devices. Each function returns the exit status: 0
// success, 1 an error of the device, 2 an error of the input.
#pragma once
#include <atomic>
#include <iosfwd>
#include <string>

namespace insula {

struct DeviceToolOptions {
  std::string device;       ///< as for --left
  int hand = 1;             ///< 0 left, 1 right: hand of the calibration, for a device without a name of its own
  double seconds = 0;       ///< duration of showing; 0: until a stop is requested
  double newtons = 1;       ///< of the force test
  double scale = 1;         ///< of the calibration: motion of the tool over motion of the hand
  bool assume_yes = false;  ///< starts the force test without asking
  int input = 0;            ///< descriptor from which the answers are read; -1: only the device's button
  double patience_s = 120;  ///< for each answer
  std::ostream* out = nullptr;
  const std::atomic<bool>* stop = nullptr;  ///< set to request a stop
};

int list_devices(std::ostream& out);
/// Shows pose, buttons and force ten times a second.
int show_device(const DeviceToolOptions& options);
/// Measures rest pose and axes from four positions to which the person moves the device, and saves them.
int calibrate_device(const DeviceToolOptions& options);
/// Pushes gently along each axis, through the safety gate.
int test_device_force(const DeviceToolOptions& options);

}  // namespace insula
