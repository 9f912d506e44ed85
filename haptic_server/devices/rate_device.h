// SPDX-License-Identifier: GPL-3.0-or-later
// Devices that a person deflects (SpaceMouse, gamepad): the deflection is a velocity of the simulated hand, which moves
// the simulated arm as the mouse does. They give no force.
#pragma once
#include <atomic>
#include <string>

#include "haptic_server/clock.h"
#include "haptic_server/devices/calibration.h"
#include "haptic_server/devices/remark.h"
#include "haptic_server/devices/simulated.h"
#include "haptic_server/triple_buffer.h"

namespace insula {

/// Deflections from -1 to 1 along and about the person's axes (x right, y away, z up).
struct RateSample {
  std::int64_t time_ns = 0;  ///< set by RateDevice
  bool valid = false;
  Vec3 v = Vec3::Zero();
  Vec3 w = Vec3::Zero();
  bool button1 = false;
  bool button2 = false;
};

struct RateSettings {
  double speed_m_s = 0.06;  ///< at full deflection
  double spin_rad_s = 1.2;
  double reach_m = 0.10;   ///< the goal stays within this distance of the hand's initial position
  double leash_m = 0.008;  ///< largest distance of the goal from the hand: 400 N/m then press with 3.2 N
  double leash_rad = 0.5;
};

class RateDevice : public Device {
 public:
  const DeviceProfile& profile() const override { return arm_.profile(); }
  bool simulated() const override { return true; }
  DeviceReading read() noexcept override;
  void write(const Vec3& force_N, const Vec3& torque_Nm) noexcept override { arm_.write(force_N, torque_Nm); }
  void face(const Quat& person_to_scene) noexcept override { person_to_scene_ = person_to_scene; }
  void place(const Pose& pose, const Vec3& centre, const Vec3& extent) noexcept override;
  void advance(double dt) noexcept override;
  std::string remark() const override { return remark_.text(); }
  const DeviceCalibration& calibration() const { return calibration_; }

  static constexpr double stale_after_s = 0.05;

 protected:
  RateDevice(const std::string& name, int hand, const DeviceCalibration& calibration,
             const RateSettings& settings = {});

  /// Called by the driver's thread, at least every 20 ms while the device is connected. Drops implausible samples.
  void deliver(RateSample sample) noexcept;
  void lost() noexcept;
  void set_remark(const std::string& text) { remark_.set(text); }

 private:
  bool fresh() noexcept;

  DeviceCalibration calibration_;
  RateSettings settings_;
  SimulatedDevice arm_;
  TripleBuffer<RateSample> samples_;
  MonotonicClock clock_;
  Quat person_to_scene_ = Quat::Identity();
  Pose placed_at_;
  HandGoal goal_;
  Remark remark_;
};

}  // namespace insula
