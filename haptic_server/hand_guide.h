// SPDX-License-Identifier: GPL-3.0-or-later
// Goal of a simulated hand: its home, the scripted motion, or a viewer's pose.
#pragma once
#include "core/sim/motion.h"
#include "haptic_server/devices/device.h"

namespace insula {

struct GuideSettings {
  double max_speed_m_s = 0.3;  ///< largest speed of the goal, for any jump of the input
  double max_spin_rad_s = 6;
  double smoothing_s = 0.025;  ///< first-order filter on the viewer's poses, which arrive at 60 Hz at most
};

/// Converts poses of any source to a goal that moves steadily, with its velocity. Neither allocates nor throws.
class HandGuide {
 public:
  explicit HandGuide(const GuideSettings& settings = {}) : settings_(settings) {}

  /// Puts the goal at rest at `pose`, and drops the viewer's pose.
  void place(const Pose& pose) noexcept;
  /// A viewer takes the hand over until the next place().
  void take_over(const HandSample& wish) noexcept;
  /// One tick. `wish` is the pose of the script (or home), which is used while no viewer has taken over.
  const HandGoal& advance(double dt, const HandSample& wish) noexcept;
  const HandGoal& goal() const { return goal_; }

 private:
  GuideSettings settings_;
  HandGoal goal_;
  HandSample viewer_;
  Pose smooth_;
  bool taken_over_ = false;
};

/// Interpolates simulated time, which arrives in steps with the problems, at the servo's rate. It runs on between two
/// steps, at most one step ahead, and never backwards.
class MotionClock {
 public:
  void reset(double sim_time) noexcept { time_ = target_ = end_ = sim_time; }
  void step_arrived(double sim_time, double step_s) noexcept;
  double advance(double dt) noexcept;
  double time() const { return time_; }

 private:
  double time_ = 0, target_ = 0, end_ = 0;
};

/// Centre and edge lengths of an arm's reach in the scene. The reach is around home, or covers the scripted motion's
/// box with its longest edge along the longest edge of the box.
void lay_workspace(const Motion* motion, int hand, const Vec3& home, const Vec3& workspace, Vec3& centre, Vec3& extent);

}  // namespace insula
