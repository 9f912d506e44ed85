// SPDX-License-Identifier: GPL-3.0-or-later
// The last stage between the servo's force and the safety gate. It applies the force scale that the scene declares and
// compensates the weight and friction of the device. It adds short transients for events that are faster than a
// rendered force.
#pragma once
#include <vector>

#include "core/constraint/problem.h"
#include "haptic_server/devices/device.h"

namespace insula {

/// A transient: amplitude exp(-t / decay) sin(2 pi frequency t) along a direction. Such transients distinguish hard
/// from soft contact. The stiffness that a device can render does not produce them (Okamura, Cutkosky, Dennerlein 2001;
/// Kuchenbecker, Fiene, Niemeyer 2006).
struct Transient {
  double amplitude_N = 0;
  double frequency_Hz = 0;
  double decay_s = 0;
};

struct ForceOutputSettings {
  double force_scale = 1;  ///< force on the hand over force in the scene
  double friction_share =
      0.8;  ///< share of the device's friction that is compensated: below 1, so that the rest still damps
  bool transients = true;
};

/// Output of one hand. Never allocates, never throws.
class ForceOutput {
 public:
  void set(const ForceOutputSettings& settings) noexcept { settings_ = settings; }
  const ForceOutputSettings& settings() const { return settings_; }
  /// Starts a transient. A transient that is still active continues if it is stronger.
  void start_transient(const Vec3& direction, const Transient& transient) noexcept;
  /// Force for the gate. v: velocity of the device, m/s; up: unit vector, scene frame. live: the force is the servo's
  /// solution of a live problem. If it is false, nothing is added and an active transient ends.
  Vec3 apply(const DeviceProfile& device, double dt, const Vec3& force_N, const Vec3& v, const Vec3& up,
             bool live) noexcept;

  static constexpr double slow_m_s =
      0.01;  ///< speed from which friction is compensated in full; at rest its direction is not known

 private:
  ForceOutputSettings settings_;
  Transient sounding_;
  Vec3 along_ = Vec3::Zero();
  double since_s_ = 0;
};

/// Detects the onset of contact of a hand's tool: a force after some time without one.
class Onset {
 public:
  /// True at the tick of the onset.
  bool met(double dt, double force_N) noexcept;

 private:
  double out_of_touch_s_ = 1;
};

/// Hardness of what the hand's tool presses on: the tool's own compliance at its hardest loaded contact over the total
/// compliance there. 0: no contact; 1: a rigid wall.
double hardness(const ConstraintProblem& problem, int hand, const std::vector<double>& lambda) noexcept;

/// Transient of an impact at this speed. Tissue, which is much more compliant than the tool's coupling, causes none.
Transient impact_transient(double speed_m_s, double hardness);
inline constexpr Transient severing_transient{0.12, 180, 0.012};
inline constexpr Transient latching_transient{0.25, 250, 0.010};

}  // namespace insula
