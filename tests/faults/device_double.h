// SPDX-License-Identifier: GPL-3.0-or-later
// A real arm for the haptic server. A person holds it, presses into tissue and draws along it. It fails on request, and
// it records whether the forces kept to its profile.
#pragma once
#include <algorithm>
#include <cmath>
#include <limits>
#include <sstream>
#include <string>

#include "haptic_server/clock.h"
#include "haptic_server/devices/arm_model.h"

namespace insula::testing {

enum class DeviceError {
  none,
  gone,  ///< says that it is not connected
  nan_pose,
  far_pose,  ///< a million metres away
  crooked,   ///< orientation is no unit quaternion
  jumps,     ///< five millimetres to and fro, every tick
  stuck,     ///< the same reading again and again
  nan_speed,
};

class DeviceDouble final : public Device {
 public:
  DeviceDouble(int hand, const Clock& clock) : clock_(clock), arm_(parameters()), side_(hand == 0 ? -1 : 1) {
    arm_.place(goal().pose, goal().pose.p, Vec3::Constant(1));
    reading_ = now();
  }

  DeviceError error = DeviceError::none;

  const DeviceProfile& profile() const override { return arm_.parameters().profile; }

  DeviceReading read() noexcept override {
    if (error != DeviceError::stuck) reading_ = now();
    DeviceReading r = reading_;
    const double nan = std::numeric_limits<double>::quiet_NaN();
    if (error == DeviceError::gone) r.connected = false;
    if (error == DeviceError::nan_pose) r.pose.p.y() = nan;
    if (error == DeviceError::far_pose) r.pose.p.x() = 1e6;
    if (error == DeviceError::crooked) r.pose.q.coeffs() *= 1.0003;
    if (error == DeviceError::jumps) r.pose.p.z() += 0.005 * ((++reads_ & 1) ? 1 : -1);
    if (error == DeviceError::nan_speed) r.v.z() = nan;
    return r;
  }

  void write(const Vec3& force_N, const Vec3& torque_Nm) noexcept override {
    const std::int64_t t = clock_.now_ns();
    const double dt = written_ns_ == 0 ? 1e-3 : std::clamp(double(t - written_ns_) * 1e-9, 0.0, 0.005);
    written_ns_ = t;
    check("force", force_N, force_, profile().max_force_N, profile().max_slew_N_s * dt);
    check("torque", torque_Nm, torque_, profile().max_torque_Nm, profile().max_slew_Nm_s * dt);
    force_ = force_N;
    torque_ = torque_Nm;
    arm_.set_load(force_N, torque_Nm);
  }

  /// Advances the arm and the person under the last force.
  void live(double dt) {
    time_ += dt;
    arm_.set_goal(goal());
    arm_.step(dt);
  }

  const Vec3& force() const { return force_; }
  const Vec3& torque() const { return torque_; }
  /// The first write that broke a rule, in words; empty: none did.
  const std::string& broken() const { return broken_; }

 private:
  static ArmParameters parameters() {
    ArmParameters p;
    p.profile = omni_profile();
    p.profile.name = "double";
    p.profile.max_torque_Nm = 0.05;  // an Omni has none: so that torques are watched too
    p.profile.max_slew_Nm_s = 1;
    return p;
  }
  HandGoal goal() const {
    HandGoal g;
    g.pose.p = Vec3(side_ * 0.02 + 0.004 * std::sin(2.5 * time_), 0,
                    std::max(-0.006, 0.001 - 0.01 * time_) + 0.001 * std::sin(6 * time_));
    g.stops = false;
    return g;
  }
  DeviceReading now() const {
    DeviceReading r;
    r.connected = true;
    r.pose = arm_.pose();
    r.v = arm_.v();
    r.w = arm_.w();
    return r;
  }
  void check(const char* what, const Vec3& value, const Vec3& last, double limit, double change) {
    if (!broken_.empty()) return;
    const char* rule = !value.allFinite()                                    ? "not finite"
                       : value.norm() > limit * (1 + 1e-9)                   ? "over the limit"
                       : (value - last).norm() > change * (1 + 1e-9) + 1e-15 ? "faster than the slew limit"
                                                                             : nullptr;
    if (rule == nullptr) return;
    std::ostringstream out;
    out << what << " " << rule << " at " << time_ << " s: " << value.transpose() << " after " << last.transpose();
    broken_ = out.str();
  }

  const Clock& clock_;
  ArmModel arm_;
  double side_, time_ = 0;
  std::int64_t written_ns_ = 0;
  int reads_ = 0;
  DeviceReading reading_;
  Vec3 force_ = Vec3::Zero(), torque_ = Vec3::Zero();
  std::string broken_;
};

}  // namespace insula::testing
