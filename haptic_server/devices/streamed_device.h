// SPDX-License-Identifier: GPL-3.0-or-later
// Common base of all drivers of real arms. Samples come from the driver's thread, forces go back to it, and the servo
// waits for neither.
#pragma once
#include <atomic>
#include <string>

#include "haptic_server/clock.h"
#include "haptic_server/devices/calibration.h"
#include "haptic_server/devices/device.h"
#include "haptic_server/devices/device_sample.h"
#include "haptic_server/devices/remark.h"
#include "haptic_server/triple_buffer.h"

namespace insula {

/// The servo thread calls read, write, face and place. One driver thread calls deliver, lost and wanted.
class StreamedDevice : public Device {
 public:
  const DeviceProfile& profile() const override { return profile_; }
  DeviceReading read() noexcept override;
  void write(const Vec3& force_N, const Vec3& torque_Nm) noexcept override;
  void face(const Quat& person_to_scene) noexcept override { person_to_scene_ = person_to_scene; }
  void place(const Pose& pose, const Vec3& centre, const Vec3& extent) noexcept override;
  std::string remark() const override { return remark_.text(); }

  const DeviceCalibration& calibration() const { return calibration_; }
  /// The newest sample as the device measured it, for a calibration. Called by the servo thread.
  DeviceSample raw() noexcept;
  /// Number of implausible samples.
  std::int64_t refused() const { return refused_.load(std::memory_order_relaxed); }

  /// A device without a sample for this time counts as disconnected.
  static constexpr double stale_after_s = 0.05;
  /// If the servo is silent for longer, the force fades out and is zero at stale_after_s. When the servo is back, the
  /// force fades in within another stale_after_s, so that a stall does not end in a jump.
  static constexpr double silent_after_s = 0.02;

 protected:
  explicit StreamedDevice(DeviceCalibration calibration) : calibration_(std::move(calibration)) {}

  /// Takes a measurement. Drops and counts implausible ones.
  void deliver(DeviceSample sample) noexcept;
  /// Called when the device is disconnected. The next read reports it.
  void lost() noexcept;
  /// The force to send now, within the limits of the connected device.
  DeviceForce wanted() noexcept;
  /// Sets the limits of the connected device if they are below the profile's, since another device may be connected
  /// now.
  void limit(double force_N, double torque_Nm);
  void set_remark(const std::string& text) { remark_.set(text); }

  DeviceProfile profile_;  ///< complete when start() returns, constant from then on

 private:
  DeviceCalibration calibration_;
  TripleBuffer<DeviceSample> samples_;
  TripleBuffer<DeviceForce> forces_;
  std::atomic<double> limit_N_{0}, limit_Nm_{0};
  std::atomic<std::int64_t> refused_{0};
  Quat person_to_scene_ = Quat::Identity();
  Pose home_;
  DeviceSample last_;
  double fade_ = 1;  ///< factor of the force while the servo is silent
  std::int64_t wanted_ns_ = 0;
  MonotonicClock clock_;
  Remark remark_;
};

}  // namespace insula
