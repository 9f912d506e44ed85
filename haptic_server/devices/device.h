// SPDX-License-Identifier: GPL-3.0-or-later
// What the servo needs of a haptic device. SI units, scene frame: a driver applies its own calibration.
#pragma once
#include <chrono>
#include <string>

#include "core/base/math.h"

namespace insula {

/// What a device can do, as data. A driver of a new device fills this in; the safety gate obeys it.
struct DeviceProfile {
  std::string name;
  double max_force_N = 3.3;          ///< largest force vector it may be sent
  double max_torque_Nm = 0;          ///< largest torque vector; 0: the device gives forces only
  double max_slew_N_s = 66;          ///< largest change of force: from nothing to all in 50 ms
  double max_slew_Nm_s = 0;          ///< largest change of torque
  double ramp_in_s = 0.25;           ///< forces arrive over this time
  double ramp_out_s = 0.05;          ///< and leave over this time
  double resolution_m = 0;           ///< of the position it reports, 0: continuous
  Vec3 workspace_m = Vec3::Zero();   ///< edge lengths of the box it reaches
  double friction_N = 0;             ///< backdrive friction at the tip, 0: not known
  double apparent_mass_kg = 0;       ///< of the arm at the tip, 0: not known
  bool gravity_compensated = false;  ///< the device or its software carries the arm's own weight
  double weight_N = 0;               ///< of the arm at the tip, where neither does and it is known: Feel carries it
};

/// What a device reports at a tick.
struct DeviceReading {
  bool connected = false;
  Pose pose;              ///< scene frame
  Vec3 v = Vec3::Zero();  ///< m/s
  Vec3 w = Vec3::Zero();  ///< rad/s, scene frame
  bool button1 = false;
  bool button2 = false;
};

/// Where a simulated holder wants its hand. Real devices are held by a person and ignore it.
struct HandGoal {
  Pose pose;
  Vec3 v = Vec3::Zero();
  Vec3 w = Vec3::Zero();
  bool button1 = false;
  bool button2 = false;
  bool stops = true;  ///< the arm's mechanical stops count
};

/// Between two tries to find a device that is gone.
inline constexpr auto reopen_after = std::chrono::milliseconds(500);

/// One arm. start/stop may block and may throw; read, write, guide, place and advance run in the servo thread: they
/// must neither allocate, block nor throw. The force passed to write has gone through the safety gate.
class Device {
 public:
  virtual ~Device() = default;
  virtual const DeviceProfile& profile() const = 0;
  virtual void start() {}
  virtual void stop() {}
  virtual DeviceReading read() noexcept = 0;
  virtual void write(const Vec3& force_N, const Vec3& torque_Nm) noexcept = 0;
  /// True when this program also plays the hand (guide, place and advance do something).
  virtual bool simulated() const { return false; }
  virtual void guide(const HandGoal&) noexcept {}
  /// Turns the axes of the person in front of the screen (x right, y away, z up) into the scene's.
  virtual void face(const Quat& /*person_to_scene*/) noexcept {}
  /// Puts a simulated arm at rest at a pose, its reach centred at `centre` with edge lengths `extent` (scene axes, m).
  /// A real arm stays where it is: its calibrated rest pose becomes that pose.
  virtual void place(const Pose& /*pose*/, const Vec3& /*centre*/, const Vec3& /*extent*/) noexcept {}
  /// Any thread but the servo's: what keeps it from working, for the person who holds it; empty when all is well.
  virtual std::string remark() const { return {}; }
  /// Lets a simulated arm live on by dt (s) under the force written last.
  virtual void advance(double /*dt*/) noexcept {}
};

}  // namespace insula
