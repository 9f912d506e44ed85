// SPDX-License-Identifier: GPL-3.0-or-later
// What URDF cannot say about a tool: cutting edge, suction opening, a clip's spring, in tool.json beside the URDF.
//   {"unit": "mm", "tip": {"kind": "suction", "inner_radius_mm": 0.7},
//    "blade": {"edge": [[x,y,z], [x,y,z], ...], "cuts": true},
//    "rounding_mm": {"jaw_left_1": 0.2},                  radius about the hull of that collision
//    "clip": {"kind": "permanent", "shape": "straight", "blade_length_mm": 9, "blade_width_mm": 1.2, "closing_force_N": 1.7,
//             "force_slope_N_per_m": 350, "reference_mm": 11, "friction": 0.3, "blade_from": [x,y,z], "blade_to": [x,y,z],
//             "blade_line": [[x,y,z], ...], "grip": {"position": [x,y,z], "shaft": [x,y,z], "flat": [x,y,z]},
//             "fenestration": {"centre": [x,y,z], "axis": [x,y,z], "diameter_mm": 5}}}
// blade_line and fenestration may be missing; other keys are for people and generators.
#pragma once
#include <filesystem>

#include "core/model/tools/tool_model.h"

namespace insula {

/// Fills blade_edges (the segments of the polyline, only when it cuts), tip_inner_radius, the pieces' radii and clip; links,
/// hinges and pieces are those already read from the URDF. A missing file is fine.
/// Throws InputError: malformed, wrong unit, not finite, out of range.
void read_tool_json(const std::filesystem::path& file, ToolModel& tool);

}  // namespace insula
