// SPDX-License-Identifier: GPL-3.0-or-later
// The servo's interface to a haptic device. SI units, scene frame. A driver applies its own calibration.
#pragma once
#include <chrono>
#include <string>

#include "core/base/math.h"

namespace insula {

/// Properties and limits of a device. The driver fills them in, and the safety gate enforces them.
struct DeviceProfile {
  std::string name;
  double max_force_N = 3.3;          ///< largest force vector that may be sent to it
  double max_torque_Nm = 0;          ///< largest torque vector; 0: the device gives forces only
  double max_slew_N_s = 66;          ///< largest change of force: from zero to the maximum in 50 ms
  double max_slew_Nm_s = 0;          ///< largest change of torque
  double ramp_in_s = 0.25;           ///< time in which forces fade in
  double ramp_out_s = 0.05;          ///< time in which forces fade out
  double resolution_m = 0;           ///< of the position it reports, 0: continuous
  Vec3 workspace_m = Vec3::Zero();   ///< edge lengths of the box that it reaches
  double friction_N = 0;             ///< backdrive friction at the tip, 0: not known
  double apparent_mass_kg = 0;       ///< of the arm at the tip, 0: not known
  bool gravity_compensated = false;  ///< the device or its software compensates the arm's weight
  double weight_N = 0;  ///< of the arm at the tip, if it is known and not compensated: ForceOutput compensates it
};

/// Measurement of a device at a tick.
struct DeviceReading {
  bool connected = false;
  Pose pose;              ///< scene frame
  Vec3 v = Vec3::Zero();  ///< m/s
  Vec3 w = Vec3::Zero();  ///< rad/s, scene frame
  bool button1 = false;
  bool button2 = false;
};

/// Goal of a simulated hand. Real devices are held by a person and ignore it.
struct HandGoal {
  Pose pose;
  Vec3 v = Vec3::Zero();
  Vec3 w = Vec3::Zero();
  bool button1 = false;
  bool button2 = false;
  bool stops = true;  ///< whether the arm's mechanical stops act
};

/// Time between two attempts to find a device that is gone.
inline constexpr auto reopen_after = std::chrono::milliseconds(500);

/// One arm. start and stop may block and throw. read, write, guide, place and advance run in the servo thread and must
/// not allocate, block or throw. The force passed to write has passed the safety gate.
class Device {
 public:
  virtual ~Device() = default;
  virtual const DeviceProfile& profile() const = 0;
  virtual void start() {}
  virtual void stop() {}
  virtual DeviceReading read() noexcept = 0;
  virtual void write(const Vec3& force_N, const Vec3& torque_Nm) noexcept = 0;
  /// Whether this program also simulates the hand, so that guide, place and advance have an effect.
  virtual bool simulated() const { return false; }
  virtual void guide(const HandGoal&) noexcept {}
  /// Sets the rotation from the axes of the person in front of the screen (x right, y away, z up) to those of the
  /// scene.
  virtual void face(const Quat& /*person_to_scene*/) noexcept {}
  /// Puts a simulated arm at rest at a pose. Its reach is a box around `centre` with edge lengths `extent` (scene axes,
  /// m). A real arm stays where it is, and its calibrated rest pose is mapped to that pose.
  virtual void place(const Pose& /*pose*/, const Vec3& /*centre*/, const Vec3& /*extent*/) noexcept {}
  /// Any thread except the servo's: reason why it does not work, for its user; empty if it works.
  virtual std::string remark() const { return {}; }
  /// Advances a simulated arm by dt (s) under the last force.
  virtual void advance(double /*dt*/) noexcept {}
};

}  // namespace insula
