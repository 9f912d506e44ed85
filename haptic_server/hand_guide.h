// SPDX-License-Identifier: GPL-3.0-or-later
// Where a simulated hand wants to be: at home, along the scripted motion, or where a viewer points.
#pragma once
#include "core/sim/motion.h"
#include "haptic_server/devices/device.h"

namespace insula {

struct GuideSettings {
  double max_speed_m_s = 0.3;  ///< however far the wish jumps, the goal moves no faster
  double max_spin_rad_s = 6;
  double smoothing_s = 0.025;  ///< first-order filter on the viewer's poses, which come at 60 Hz at best
};

/// Turns wishes of any source into a goal that moves steadily, with its velocity. Neither allocates nor throws.
class HandGuide {
 public:
  explicit HandGuide(const GuideSettings& settings = {}) : settings_(settings) {}

  /// Goal at rest at `pose`; forgets the viewer's wish.
  void place(const Pose& pose) noexcept;
  /// A viewer takes the hand over until the next place().
  void take_over(const HandSample& wish) noexcept;
  /// One tick; `wish` is what the script (or home) asks for and counts while no viewer has taken over.
  const HandGoal& advance(double dt, const HandSample& wish) noexcept;
  const HandGoal& goal() const { return goal_; }

 private:
  GuideSettings settings_;
  HandGoal goal_;
  HandSample viewer_;
  Pose smooth_;
  bool taken_over_ = false;
};

/// Follows simulated time, which arrives in steps with the problems, smoothly at the servo's rate: runs on by itself
/// between two steps, at most one step ahead, and never backwards.
class MotionClock {
 public:
  void reset(double sim_time) noexcept { time_ = target_ = end_ = sim_time; }
  void step_arrived(double sim_time, double step_s) noexcept;
  double advance(double dt) noexcept;
  double time() const { return time_; }

 private:
  double time_ = 0, target_ = 0, end_ = 0;
};

/// Centre and edge lengths of an arm's reach in the scene. The person who sets up a device lays its reach over the
/// field: around home, or over the scripted motion's box with the longest edge of the reach along the longest edge of
/// the box.
void lay_workspace(const Motion* motion, int hand, const Vec3& home, const Vec3& workspace, Vec3& centre, Vec3& extent);

}  // namespace insula
