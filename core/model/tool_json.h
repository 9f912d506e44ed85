// SPDX-License-Identifier: GPL-3.0-or-later
// What URDF cannot say about a tool: the cutting edge and the suction opening, in tool.json beside the URDF.
//   {"unit": "mm", "tip": {"kind": "suction", "inner_radius_mm": 0.7},
//    "blade": {"edge": [[x,y,z], [x,y,z], ...], "cuts": true}}       other keys are for people and generators
#pragma once
#include <filesystem>

#include "core/model/tool_model.h"

namespace insula {

/// Fills blade_edges (the segments of the polyline, only when it cuts) and tip_inner_radius. A missing file is fine.
/// Throws InputError: malformed, wrong unit, not finite.
void read_tool_json(const std::filesystem::path& file, ToolModel& tool);

}  // namespace insula
