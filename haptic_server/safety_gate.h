// SPDX-License-Identifier: GPL-3.0-or-later
// The gate in front of every device. For any input, its output is finite, within the device's limits, and changes no
// faster than the device's slew limit.
#pragma once
#include <cstdint>

#include "haptic_server/devices/device.h"

namespace insula {

/// Rules in this order at every tick:
///   1. A force that is not finite counts as zero.
///   2. |force| <= max_force. The vector is shortened, and its direction is kept.
///   3. Fade-in: the force of a source that has (re)appeared is scaled from 0 to 1 over ramp_in_s.
///   4. Fade-out: without a live source the last force goes linearly to exactly 0 within ramp_out_s.
///   5. |force - last force| <= max_slew * dt. This last rule has no exception.
/// The same holds for the torque with its own limits. Never allocates, never throws.
class SafetyGate {
 public:
  /// Limits that are not positive and finite close that channel (it sends zero).
  explicit SafetyGate(const DeviceProfile& profile);

  /// dt: since the last call, s. More than 5 ms counts as 5 ms; a value that is not positive counts as zero.
  /// live: the force comes from a fresh solve of a recent problem.
  void apply(double dt, bool live, const Vec3& force_N, const Vec3& torque_Nm) noexcept;

  const Vec3& force() const { return force_.out; }    ///< N, to the device
  const Vec3& torque() const { return torque_.out; }  ///< N m, to the device
  double gain() const { return gain_; }               ///< ramp, 0 to 1
  /// Number of inputs that were not finite.
  std::int64_t refused() const { return refused_; }
  /// Ticks at which the force was shortened to the device's limit.

  static constexpr double longest_tick_s = 0.005;
  /// A problem older than this is not a live source.
  static constexpr double stale_after_s = 0.05;

 private:
  struct Channel {
    double limit = 0;
    double slew = 0;
    Vec3 out = Vec3::Zero();
    Vec3 held = Vec3::Zero();  ///< sent when the source was lost
    void step(double dt, const Vec3& wanted);
  };
  Channel force_, torque_;
  double ramp_in_s_, ramp_out_s_;
  double gain_ = 0;
  double fade_ = 0;  ///< remaining share of `held`, 1 to 0
  bool live_ = false;
  std::int64_t refused_ = 0;
};

}  // namespace insula
