// SPDX-License-Identifier: GPL-3.0-or-later
// Properties of a tool that URDF does not have: cutting edge, suction opening, sections for plugins. They are in
// tool.json beside the URDF.
//   {"unit": "mm", "tip": {"kind": "suction", "inner_radius_mm": 0.7},
//    "blade": {"edge": [[x,y,z], [x,y,z], ...], "cuts": true},
//    "rounding_mm": {"jaw_left_1": 0.2},                  radius about the hull of that collision
//    "spring": {...}}                                     any other key is a section for the plugin that knows it
#pragma once
#include <filesystem>

#include "core/model/tools/tool_model.h"

namespace insula {

/// Fills blade_edges (the segments of the polyline, if it cuts), tip_inner_radius, the pieces' radii and sections.
/// Links, hinges and pieces have been read from the URDF before. The file may be missing. Throws InputError: malformed,
/// wrong unit, not finite, out of range.
void read_tool_json(const std::filesystem::path& file, ToolModel& tool);

}  // namespace insula
