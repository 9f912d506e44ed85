// SPDX-License-Identifier: GPL-3.0-or-later
// What an author has painted into a scan, or rubbed out of it, by hand.
#pragma once
#include <filesystem>
#include <vector>

#include "tools/case_builder/options.h"
#include "tools/mesh_lobes/volume.h"

namespace insula::case_builder {

/// A file with [{"erase": false, "radius_mm": 1, "points": [[x, y, z], ...]}, ...], mm. Throws InputError.
std::vector<Stroke> read_strokes(const std::filesystem::path& file);

/// Sets or clears the nodes within the radius of each stroke's line, in the strokes' order.
void paint(const mesh_tool::Grid& grid, mesh_tool::Mask& mask, const std::vector<Stroke>& strokes);

}  // namespace insula::case_builder
