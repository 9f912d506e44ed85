// SPDX-License-Identifier: GPL-3.0-or-later
// A simulation with both hands inside the process, in simulated time: the servo's ticks and the engine's steps in a fixed order.
#pragma once
#include <memory>

#include "core/sim/simulation.h"
#include "haptic_server/in_process.h"

namespace insula {

class HeadlessRun {
 public:
  /// Hands follow the motion; one it does not move stays at its tool's home.
  HeadlessRun(Simulation& simulation, const Motion& motion);

  /// The servo's ticks up to the end of the coming step, then the step with the hands as they then are.
  void step();
  /// Simulation and hands back to the start.
  void reset();
  const InProcessHaptics& haptics() const { return haptics_; }
  Simulation& simulation() { return simulation_; }
  double haptic_ms() const { return haptic_ms_; }  ///< wall time of the last step's ticks

 private:
  Simulation& simulation_;
  InProcessHaptics haptics_;
  double haptic_ms_ = 0;
  ConstraintProblem condensed_;
};

}  // namespace insula
