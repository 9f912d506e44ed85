// SPDX-License-Identifier: GPL-3.0-or-later
// The simulated arm as a device, with quantised position, tracked velocity, and the limits of a real arm.
#pragma once
#include "haptic_server/devices/arm_model.h"

namespace insula {

class SimulatedDevice final : public Device {
 public:
  explicit SimulatedDevice(const ArmParameters& parameters);

  const DeviceProfile& profile() const override { return arm_.parameters().profile; }
  DeviceReading read() noexcept override;
  void write(const Vec3& force_N, const Vec3& torque_Nm) noexcept override;
  bool simulated() const override { return true; }
  void guide(const HandGoal& goal) noexcept override;
  void place(const Pose& pose, const Vec3& centre, const Vec3& extent) noexcept override;
  void advance(double dt) noexcept override;

  const ArmModel& arm() const { return arm_; }

 private:
  Vec3 measured() const;

  ArmModel arm_;
  EncoderTracker tracker_;
  bool placed_ = false;
};

}  // namespace insula
