// SPDX-License-Identifier: GPL-3.0-or-later
// A part of a volume.
#pragma once
#include <filesystem>

#include "tools/case_builder/options.h"
#include "tools/mesh_lobes/volume.h"

namespace insula::case_builder {

/// The voxels within `mm` of a point along each axis of the volume. Throws InputError, with the file's name, if there
/// are none.
mesh_tool::NiftiVolume cropped(const std::filesystem::path& file, const mesh_tool::NiftiVolume& volume,
                               const Point& middle, double mm);

}  // namespace insula::case_builder
