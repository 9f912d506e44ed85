// SPDX-License-Identifier: GPL-3.0-or-later
// Force Dimension's omega, delta and sigma, and the Novint Falcon, through libdhd.
#pragma once
#include <atomic>
#include <memory>
#include <string>
#include <thread>

#include "haptic_server/devices/forcedimension_api.h"
#include "haptic_server/devices/streamed_device.h"

namespace insula {

/// Calls of the library wait for the device's bus, so the driver makes them in its own thread, a thousand times a
/// second. Force Dimension frame: x to the person, y right, z up; metres.
class ForceDimensionDevice final : public StreamedDevice {
 public:
  /// `which`: a serial number, "#0", "#1"... in the library's order, or empty: the first one that is not in use by the
  /// other hand.
  explicit ForceDimensionDevice(const std::string& which, DeviceCalibration calibration = default_calibration());
  ~ForceDimensionDevice() override;
  /// Throws InputError when the library is missing. Waits for a missing device in the background.
  void start() override;
  void stop() override;

  static DeviceCalibration default_calibration();

 private:
  void serve();
  bool open();
  bool tick();
  void close();

  int index_ = -1, serial_ = -1;
  std::string title_;
  std::shared_ptr<dhd::Api> api_;
  std::thread thread_;
  std::atomic<bool> stopping_{false};
  bool profile_fixed_ = false;
  bool torques_ = false;
  int id_ = -1;
};

}  // namespace insula
