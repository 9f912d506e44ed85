// SPDX-License-Identifier: GPL-3.0-or-later
// On what the bodies of a recording were solved, where their scene leaves it to the machine (solver="opencl" and
// solver="faster"). A recording says "solver.ID" with the name of the device, or "processor".
#pragma once
#include <string>
#include <vector>

#include "core/container/mcap_format.h"
#include "core/scene/edits.h"
#include "core/sim/simulation.h"

namespace insula::session {

/// Adds them to the description of a session.
void describe_solvers(const Simulation& simulation, mcap::Text& about);

struct RepeatedSolvers {
  std::vector<SceneEdit> edits;  ///< give each such body the recorded solver
  /// Bodies whose device is not that of this machine, with its name. They are solved on the processor, with other bits.
  std::vector<std::string> missing;
};
/// For the same bodies in a rerun on this machine.
RepeatedSolvers repeat_solvers(const mcap::Text& about);

}  // namespace insula::session
