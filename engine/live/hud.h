// SPDX-License-Identifier: GPL-3.0-or-later
// Data shown beside the image: goals, faults, clocks, measures and the tools of the hands.
#pragma once
#include <string>

#include "core/sim/simulation.h"
#include "engine/live/session_mode.h"

namespace insula {

class CauseLines;

/// The hud_json of render_frame_t for the last step. It has the same keys with and without an exercise
/// (docs/scripting.md). causes: keeps what is near a hint from call to call; null: it is made anew.
std::string hud_json(const Simulation& simulation, const SessionNote& note = {}, CauseLines* causes = nullptr);

}  // namespace insula
