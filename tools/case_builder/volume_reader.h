// SPDX-License-Identifier: GPL-3.0-or-later
// Scalar volumes from NIfTI, MetaImage, NRRD and DICOM through ITK.
#pragma once
#include <filesystem>

#include "tools/mesh_lobes/volume.h"

namespace insula::case_builder {

/// The volume in right-anterior-superior millimetres. Throws InputError: unreadable, truncated, not three-dimensional,
/// more than one value a voxel, spacing that is none, slices that do not stand at even distances, more than 1,000
/// million voxels.
mesh_tool::NiftiVolume read_volume(const std::filesystem::path& path);

}  // namespace insula::case_builder
