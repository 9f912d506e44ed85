// SPDX-License-Identifier: GPL-3.0-or-later
// Both haptic arms inside the engine's process, in simulated time: the same servo, gate and arms as the haptic server,
// without threads and clocks. A run gives the same bits every time.
#pragma once
#include <array>
#include <cstdint>

#include "core/constraint/problem.h"
#include "core/sim/motion.h"
#include "haptic_server/devices/simulated.h"
#include "haptic_server/hand_guide.h"
#include "haptic_server/safety_gate.h"
#include "haptic_server/servo.h"

namespace insula {

struct HandHome {
  bool present = false;
  Pose pose;
};

/// Use in each engine step of length h:
///   haptics.set_problem(problem of the step that ended at time T)
///   for k = 1..n: haptics.tick(T + k h / n)                          n = about h / 1 ms
///   hand(i).device, button1, button2 -> instruments of the next step
class InProcessHaptics {
 public:
  struct Hand {
    bool present = false;  ///< placed; follows the motion if that has keys for the hand
    Pose device;           ///< as the device reports it, scene frame
    Vec3 v = Vec3::Zero();
    bool button1 = false;
    bool button2 = false;
    Vec3 force = Vec3::Zero();      ///< sent to the device at the last tick, N
    Vec3 torque = Vec3::Zero();     ///< N m
    double max_force_N = 0;         ///< since the start
    std::int64_t fresh_forces = 0;  ///< number of forces from a new solve that differ from the one before
    double touching_s = 0;          ///< time with a force; in free air there is none
  };

  /// Hands that the motion does not move stay at `home`, or are absent without a home. The others begin at the motion's
  /// start.
  using Home = HandHome;
  explicit InProcessHaptics(const Motion& motion, const std::array<Home, 2>& home = {},
                            const ServoSettings& settings = {});
  /// The same with other arms, for tests and other devices' limits.
  InProcessHaptics(const Motion& motion, const std::array<Home, 2>& home, const ServoSettings& settings,
                   const std::array<ArmParameters, 2>& arms);

  /// Returns to the start of the motion, with arms at rest and counters at zero.
  void reset();
  /// Copies the newest problem, except for the tools of the hands in `left_out`.
  void set_problem(const ConstraintProblem& problem, const std::array<bool, 2>& left_out = {});
  /// One servo tick that ends at simulated time t (s), later than the last one. The first tick after reset takes 1 ms.
  void tick(double t);
  /// n ticks of dt from the last tick's time on.
  void advance(int ticks, double dt = 1e-3);

  const Hand& hand(int i) const { return hands_[std::size_t(i)]; }
  double time() const { return time_; }
  std::int64_t ticks() const { return ticks_; }
  /// Result of the last tick.
  const ServoResult& last() const { return last_; }
  /// Fresh forces per simulated second of contact: the smaller value of the hands that had contact; 0 if none had.
  double fresh_forces_per_s() const;

 private:
  Motion motion_;
  std::array<Home, 2> home_;
  std::array<SimulatedDevice, 2> device_;
  std::array<SafetyGate, 2> gate_;
  std::array<HandGuide, 2> guide_;
  Servo servo_;
  // Two copies: the servo reads the old one until it has taken what it needs from it.
  std::array<ConstraintProblem, 2> problem_;
  std::size_t current_ = 0;
  std::array<Hand, 2> hands_;
  std::array<Vec3, 2> last_force_{Vec3::Zero(), Vec3::Zero()};
  ServoResult last_;
  double time_ = 0, problem_time_ = 0;
  std::int64_t ticks_ = 0;
  bool started_ = false;
};

}  // namespace insula
