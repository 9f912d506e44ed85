// SPDX-License-Identifier: GPL-3.0-or-later
// The content of a frame for the viewers.
#pragma once
#include <insula_lcm/render_frame_t.hpp>

#include "core/sim/simulation.h"
#include "engine/live/session_mode.h"

namespace insula {

class CauseLines;
class DeformableBody;

/// The bodies of frames and bundles: deformable bodies in document order. A body's position in the list is its `index`
/// there.
std::vector<const DeformableBody*> picture_bodies(const Simulation& simulation);

/// The tools of frames and bundles: instruments in document order, then all other rigid bodies in document order.
std::vector<const RigidBody*> picture_tools(const Simulation& simulation);

/// Fills a frame from the simulation's last step; keeps the capacity of its vectors. The caller fills the header
/// fields. causes: as for hud_json().
void fill_frame(const Simulation& simulation, insula_lcm::render_frame_t& frame, const SessionNote& note = {},
                CauseLines* causes = nullptr);

}  // namespace insula
