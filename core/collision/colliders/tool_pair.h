// SPDX-License-Identifier: GPL-3.0-or-later
// Tool against tool.
//
// In a long step a hand leads one tip past another. A normal that holds for the whole step would stop it, although it
// only grazes the other tip or passes it. So each pair of pieces is followed along its motion in short parts. Where it
// would overlap, a is displaced along the normal there, by no more than is necessary. If it is displaced at the end of
// the step, that is the contact, since the row acts there. Else the contact is the closest approach, whose plane is
// parallel to the motion. A tool that passes through another one within the step is stopped by the normal that it had
// before.
//
// The closest approach is searched for beyond the step, too, up to `collision_horizon`, since the haptic loop uses the
// contact until the next step.
#pragma once
#include <vector>

#include "core/collision/colliders/tool_collider.h"

namespace insula {

/// A tool in a step, scene frame. `end` is its free pose, or where a pressing tool is expected.
struct ToolMotion {
  Pose start, end;
};

/// Appends one contact for each pair of pieces that is within the alarm distance, or comes within it. Pieces whose
/// cores meet at the start are pushed apart along the line between their middles. start_gap + H dq is the gap at the
/// end of the path if both tools move as they do there.
void detect_tools(const std::vector<RoundedPiece>& a, const ToolMotion& motion_a, const std::vector<RoundedPiece>& b,
                  const ToolMotion& motion_b, const ToolContactSettings& settings, std::vector<Proximity>& out);

}  // namespace insula
