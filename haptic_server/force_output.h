// SPDX-License-Identifier: GPL-3.0-or-later
// The last stage between the servo's force and the safety gate. It applies the force scale that the scene declares and
// compensates the weight and friction of the device. It adds short transients for events that are faster than a
// rendered force.
#pragma once
#include <vector>

#include "core/constraint/problem.h"
#include "haptic_server/devices/device.h"

namespace insula {

/// A knock: amplitude exp(-t / decay) sin(2 pi frequency t) along a direction. Contact with something hard is told from
/// something soft by such transients, which no stiffness that a device can render has (Okamura, Cutkosky, Dennerlein
/// 2001; Kuchenbecker, Fiene, Niemeyer 2006).
struct Transient {
  double amplitude_N = 0;
  double frequency_Hz = 0;
  double decay_s = 0;
};

struct ForceOutputSettings {
  double force_scale = 1;  ///< force on the hand over force in the scene
  double friction_share =
      0.8;  ///< of the device's friction that is taken off: less than all, so that what is left still damps
  bool transients = true;
};

/// One hand's. Never allocates, never throws.
class ForceOutput {
 public:
  void set(const ForceOutputSettings& settings) noexcept { settings_ = settings; }
  const ForceOutputSettings& settings() const { return settings_; }
  /// Begins a transient; one that still sounds goes on when it is the stronger one.
  void start_transient(const Vec3& direction, const Transient& transient) noexcept;
  /// Force for the gate. v: of the device, m/s; up: unit, scene frame. live: the force is the servo's answer to a live
  /// problem; when it is not, nothing is added to it and what sounds ends.
  Vec3 apply(const DeviceProfile& device, double dt, const Vec3& force_N, const Vec3& v, const Vec3& up,
             bool live) noexcept;

  static constexpr double slow_m_s =
      0.01;  ///< friction is taken off in full from this speed on: at rest its direction is not known

 private:
  ForceOutputSettings settings_;
  Transient sounding_;
  Vec3 along_ = Vec3::Zero();
  double since_s_ = 0;
};

/// Tells when a hand's tool meets something: a force after some time without.
class Onset {
 public:
  /// True at the tick in which it does.
  bool met(double dt, double force_N) noexcept;

 private:
  double out_of_touch_s_ = 1;
};

/// How little what the hand's tool presses on gives way: the tool's own compliance at its hardest pressed contact over
/// the whole there. 0: nothing is pressed on; 1: a wall.
double hardness(const ConstraintProblem& problem, int hand, const std::vector<double>& lambda) noexcept;

/// Of a tool that meets something at this speed. Tissue, which gives way much more than a tool is held, does not knock.
Transient impact_transient(double speed_m_s, double hardness);
inline constexpr Transient severing_transient{0.12, 180, 0.012};
inline constexpr Transient latching_transient{0.25, 250, 0.010};

}  // namespace insula
