// SPDX-License-Identifier: GPL-3.0-or-later
// A simulation with both hands inside the process, in simulated time: the servo's ticks and the engine's steps in a
// fixed order.
#pragma once
#include <memory>

#include "core/sim/simulation.h"
#include "engine/command_line/commands.h"
#include "engine/live/command_script.h"
#include "engine/live/lockstep_hands.h"

namespace insula {

class HeadlessRun {
 public:
  /// Hands follow the motion, and its commands are executed at their times. A hand that it does not move stays at its
  /// tool's home.
  HeadlessRun(Simulation& simulation, const Motion& motion);

  /// Runs the servo's ticks up to the end of the coming step, then the step with the hands' poses at that time.
  void step();
  /// Returns simulation and hands to the start.
  void reset();
  const InProcessHaptics& haptics() const { return hands_.haptics(); }
  Simulation& simulation() { return simulation_; }
  double haptic_ms() const { return haptic_ms_; }  ///< wall time of the last step's ticks

 private:
  Simulation& simulation_;
  LockstepHands hands_;
  CommandScript script_;
  double haptic_ms_ = 0;
};

/// A scene and one of its motions, ready to run.
struct OpenedRun {
  std::unique_ptr<Simulation> simulation;  ///< null after an error, which was printed on `err`
  Motion motion;
};
/// Loads a scene and the motion named by id or file (see find_motion). `optional`: an id that the scene does not have
/// means no motion. time_step_s: in place of the scene's own, 0: as written.
OpenedRun open_run(const CommandContext& context, const std::filesystem::path& scene, const std::string& motion,
                   bool optional, int threads, double time_step_s = 0);

}  // namespace insula
