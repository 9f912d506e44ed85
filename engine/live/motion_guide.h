// SPDX-License-Identifier: GPL-3.0-or-later
// Targets for a trainee who practises: the poses at which a motion turns, and those at which it presses or lets go a
// button. The way between two neighbours is nearly straight.
#pragma once
#include <string>
#include <vector>

#include "core/sim/motion.h"
#include "core/sim/simulation.h"

namespace insula {

struct GuidePose {
  int hand = 0;      ///< 0 left, 1 right
  std::string tool;  ///< id of the instrument that the motion has in that hand
  double time_s = 0;
  HandSample sample;
  std::string command;   ///< what the motion has asked of that instrument last, "load": empty if nothing
  std::string argument;  ///< of that command: "angled"
  /// No button is on or changes: the hand only goes there on its way.
  bool passes = false;
};

struct TargetSettings {
  double tolerance_m = 0.003;    ///< largest distance of a pose of the motion from the way between its targets
  double tolerance_rad = 0.26;   ///< largest turn against it
  std::size_t most_poses = 200;  ///< of one hand; the tolerances are doubled until they suffice
};

/// The targets of both hands, the left hand's first, each hand's in the order of time.
std::vector<GuidePose> guide_poses(const Motion& motion, const Simulation& simulation,
                                   const TargetSettings& settings = {});

}  // namespace insula
