// SPDX-License-Identifier: GPL-3.0-or-later
// Goal of a simulated hand: its home, the scripted motion, or a viewer's pose. A hand that a viewer lets go, or whose
// viewer is lost, lets its buttons go and glides back.
#pragma once
#include "core/sim/motion.h"
#include "haptic_server/devices/device.h"

namespace insula {

struct GuideSettings {
  double max_speed_m_s = 0.3;  ///< largest speed of the goal, for any jump of the input
  double max_spin_rad_s = 6;
  double smoothing_s = 0.025;      ///< first-order filter on the viewer's poses, which arrive at 60 Hz at most
  double lost_after_s = 0.3;       ///< a viewer that has sent no pose for this long is lost
  double fresh_after_s = 0.15;     ///< a stream of poses that a placement ended counts as new after such a pause
  double return_speed_m_s = 0.05;  ///< largest speed of the way back after a release
  double return_spin_rad_s = 1;
  double return_ramp_s = 0.4;  ///< time in which the way back reaches its speed
};

/// Converts poses of any source to a goal that moves steadily, with its velocity. Neither allocates nor throws.
class HandGuide {
 public:
  explicit HandGuide(const GuideSettings& settings = {}) : settings_(settings) {}

  /// Puts the goal at rest at `pose`, and drops the viewer's pose.
  void place(const Pose& pose) noexcept;
  /// A viewer takes the hand over until release(), until it is lost, or until the next place(). Poses of a viewer that
  /// had the hand at a place() are ignored until they pause or until release().
  void take_over(const HandSample& wish) noexcept;
  /// The viewer lets the hand go: its buttons are off at once, and the goal glides back to the script's pose.
  void release() noexcept;
  /// One tick. `wish` is the pose of the script (or home), which is used while no viewer has taken over.
  const HandGoal& advance(double dt, const HandSample& wish) noexcept;
  const HandGoal& goal() const { return goal_; }
  bool taken_over() const { return taken_over_; }

 private:
  void move_towards(const Pose& target, double dt, double most_m, double most_rad) noexcept;
  void glide_back(double dt, const HandSample& wish) noexcept;

  GuideSettings settings_;
  HandGoal goal_;
  HandSample viewer_;
  Pose smooth_;
  bool taken_over_ = false;
  bool returning_ = false;  ///< on the way back after a release
  bool stale_ = false;      ///< the viewer's stream began before the last place()
  double silent_s_ = 0;     ///< since the viewer's last pose
  double returning_s_ = 0;
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
