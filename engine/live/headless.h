// SPDX-License-Identifier: GPL-3.0-or-later
// A simulation with both hands inside the process, in simulated time: the servo's ticks and the engine's steps in a
// fixed order.
#pragma once
#include <memory>

#include "core/haptics/condense.h"
#include "core/sim/simulation.h"
#include "engine/command_line/commands.h"
#include "engine/live/command_script.h"
#include "engine/live/exchange_pause.h"
#include "haptic_server/in_process.h"

namespace insula {

class HeadlessRun {
 public:
  /// Hands follow the motion, whose commands are done at their times; a hand it does not move stays at its tool's home.
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
  CommandScript script_;
  double haptic_ms_ = 0;
  Condenser condense_;
  ConstraintProblem condensed_;
  ExchangePause pause_;
};

/// A scene and a motion of it, ready to run.
struct OpenedRun {
  std::unique_ptr<Simulation> simulation;  ///< null when something is wrong; it was said on `err`
  Motion motion;
};
/// Loads a scene and the motion named by id or file (see find_motion). `optional`: an id the scene lacks means no
/// motion.
OpenedRun open_run(const CommandContext& context, const std::filesystem::path& scene, const std::string& motion,
                   bool optional, int threads);

}  // namespace insula
