// SPDX-License-Identifier: GPL-3.0-or-later
// What all drivers of real arms share: samples come from a thread of their own, forces go back to it, and the servo
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

/// read, write, face and place are the servo thread's; deliver, lost and wanted the driver's thread's (one of them).
class StreamedDevice : public Device {
 public:
  const DeviceProfile& profile() const override { return profile_; }
  DeviceReading read() noexcept override;
  void write(const Vec3& force_N, const Vec3& torque_Nm) noexcept override;
  void face(const Quat& person_to_scene) noexcept override { person_to_scene_ = person_to_scene; }
  void place(const Pose& pose, const Vec3& centre, const Vec3& extent) noexcept override;
  std::string remark() const override { return remark_.text(); }

  const DeviceCalibration& calibration() const { return calibration_; }
  /// The newest sample as the device measured it, for a calibration; the servo thread's, like read.
  DeviceSample raw() noexcept;
  /// Samples that could not be true.
  std::int64_t refused() const { return refused_.load(std::memory_order_relaxed); }

  /// Without a sample for this long the device counts as gone.
  static constexpr double stale_after_s = 0.05;
  /// A servo that has been silent for longer fades the force out; at stale_after_s it is zero. When the servo is back,
  /// so is the force, within another stale_after_s: a stall must not end in a step.
  static constexpr double silent_after_s = 0.02;

 protected:
  explicit StreamedDevice(DeviceCalibration calibration) : calibration_(std::move(calibration)) {}

  /// A measurement: what cannot be true is dropped and counted.
  void deliver(DeviceSample sample) noexcept;
  /// The device is gone: the next read says so.
  void lost() noexcept;
  /// What to send now, within the limits of the device that is connected.
  DeviceForce wanted() noexcept;
  /// Limits of the connected device, where they are below the profile's (another one may have been plugged in).
  void limit(double force_N, double torque_Nm);
  void set_remark(const std::string& text) { remark_.set(text); }

  DeviceProfile profile_;  ///< complete when start() returns, the same from then on

 private:
  DeviceCalibration calibration_;
  TripleBuffer<DeviceSample> samples_;
  TripleBuffer<DeviceForce> forces_;
  std::atomic<double> limit_N_{0}, limit_Nm_{0};
  std::atomic<std::int64_t> refused_{0};
  Quat person_to_scene_ = Quat::Identity();
  Pose home_;
  DeviceSample last_;
  double fade_ = 1;  ///< what a servo that falls silent leaves of the force
  std::int64_t wanted_ns_ = 0;
  MonotonicClock clock_;
  Remark remark_;
};

}  // namespace insula
