// SPDX-License-Identifier: GPL-3.0-or-later
// What `insula devices` does: lists, shows, calibrates and tries devices. Each returns the exit status: 0 well, 1 the
// device's fault, 2 the input's.
#pragma once
#include <atomic>
#include <iosfwd>
#include <string>

namespace insula {

struct DeviceToolOptions {
  std::string device;       ///< a wish, as for --left
  int hand = 1;             ///< 0 left, 1 right: whose calibration, for a device without a name of its own
  double seconds = 0;       ///< of showing; 0: until told to stop
  double newtons = 1;       ///< of the force test
  double scale = 1;         ///< of the calibration: movement of the tool over movement of the hand
  bool assume_yes = false;  ///< start the force test without asking
  int input = 0;            ///< descriptor that the answers come from; -1: the device's button only
  double patience_s = 120;  ///< for each answer
  std::ostream* out = nullptr;
  const std::atomic<bool>* stop = nullptr;  ///< set by whoever wants it to end
};

int list_devices(std::ostream& out);
/// Live pose, buttons and force, ten lines a second.
int show_device(const DeviceToolOptions& options);
/// Rest pose and axes from four places that the person moves the device to; saved.
int calibrate_device(const DeviceToolOptions& options);
/// Pushes along each axis, gently, through the safety gate.
int test_device_force(const DeviceToolOptions& options);

}  // namespace insula
