// SPDX-License-Identifier: GPL-3.0-or-later
// What stands beside the picture: goals, faults, clocks, figures and who holds what.
#pragma once
#include <string>

#include "core/sim/simulation.h"

namespace insula {

/// The hud_json of render_frame_t, of the last step; the same keys with and without an exercise (docs/scripting.md).
std::string hud_json(const Simulation& simulation);

}  // namespace insula
