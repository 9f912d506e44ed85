// SPDX-License-Identifier: GPL-3.0-or-later
// The simulated arm behind the device interface.
#include "haptic_server/devices/simulated.h"

#include <cmath>

namespace insula {

SimulatedDevice::SimulatedDevice(const ArmParameters& parameters) : arm_(parameters) {}

Vec3 SimulatedDevice::measured() const {
  const double quantum = profile().resolution_m;
  if (!(quantum > 0)) return arm_.pose().p;
  return (arm_.pose().p / quantum).array().round() * quantum;
}

DeviceReading SimulatedDevice::read() noexcept {
  DeviceReading r;
  r.connected = placed_;
  r.pose.p = tracker_.x();
  r.pose.q = arm_.pose().q;
  r.v = tracker_.v();
  r.w = arm_.w();
  r.button1 = arm_.goal().button1;
  r.button2 = arm_.goal().button2;
  return r;
}

void SimulatedDevice::write(const Vec3& force_N, const Vec3& torque_Nm) noexcept { arm_.set_load(force_N, torque_Nm); }

void SimulatedDevice::guide(const HandGoal& goal) noexcept { arm_.set_goal(goal); }

void SimulatedDevice::place(const Pose& pose, const Vec3& centre, const Vec3& extent) noexcept {
  arm_.place(pose, centre, extent);
  tracker_.reset(pose.p);
  placed_ = true;
}

void SimulatedDevice::advance(double dt) noexcept {
  if (!placed_) return;
  arm_.step(dt);
  tracker_.update(measured(), dt);
}

}  // namespace insula
