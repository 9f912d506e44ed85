// SPDX-License-Identifier: GPL-3.0-or-later
// Limits, fades and slew of the forces sent to a device.
#include "haptic_server/safety_gate.h"

#include <algorithm>
#include <cmath>

namespace insula {
namespace {

bool finite(const Vec3& v) { return std::isfinite(v.x()) && std::isfinite(v.y()) && std::isfinite(v.z()); }

/// Shortens v to at most `limit`; stableNorm, since squaring 1e200 overflows.
void shorten(Vec3& v, double limit) {
  const double length = v.stableNorm();
  if (length <= limit) return;
  if (!(length < 1e300)) v.setZero();
  else v *= limit / length;
}

double usable(double limit) { return std::isfinite(limit) && limit > 0 ? limit : 0; }

}  // namespace

SafetyGate::SafetyGate(const DeviceProfile& profile)
    : ramp_in_s_(std::max(profile.ramp_in_s, 1e-3)), ramp_out_s_(std::max(profile.ramp_out_s, 1e-3)) {
  force_.limit = usable(profile.max_force_N);
  force_.slew = usable(profile.max_slew_N_s);
  torque_.limit = usable(profile.max_torque_Nm);
  torque_.slew = usable(profile.max_slew_Nm_s);
}

void SafetyGate::Channel::step(double dt, const Vec3& wanted) {
  Vec3 target = wanted;
  shorten(target, limit);
  const Vec3 change = target - out;
  const double length = change.norm();
  // A ramp with the limit's slope must reach its end exactly, without a rounding error.
  if (length <= slew * dt * (1 + 1e-12)) out = target;
  else if (length > 0) out += change * (slew * dt / length);
  // Rounding must not move the sum beyond the limit.
  shorten(out, limit);
}

void SafetyGate::apply(double dt, bool live, const Vec3& force_N, const Vec3& torque_Nm) noexcept {
  dt = dt > 0 ? std::min(dt, longest_tick_s) : 0;
  const bool good = finite(force_N) && finite(torque_Nm);
  if (!good) ++refused_;
  live = live && good;

  if (!live && live_) {
    force_.held = force_.out;
    torque_.held = torque_.out;
    fade_ = 1;
  }
  live_ = live;
  if (live) {
    gain_ = std::min(1.0, gain_ + dt / ramp_in_s_);
    Vec3 f = force_N, t = torque_Nm;
    shorten(f, force_.limit);
    shorten(t, torque_.limit);
    force_.step(dt, gain_ * f);
    torque_.step(dt, gain_ * t);
  } else {
    gain_ = std::max(0.0, gain_ - dt / ramp_out_s_);
    fade_ = std::max(0.0, fade_ - dt / ramp_out_s_);
    // Fifty ticks of 1/50 must end at zero exactly, without a rounding error.
    if (fade_ < 1e-9) fade_ = 0;
    force_.step(dt, fade_ * force_.held);
    torque_.step(dt, fade_ * torque_.held);
  }
}

}  // namespace insula
