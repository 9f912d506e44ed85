// SPDX-License-Identifier: GPL-3.0-or-later
// A first look at a scan, from which an author chooses the vessel: its values, a proposed threshold, and a block of
// voxels that a page can draw.
#pragma once
#include <string>

#include "tools/case_builder/options.h"
#include "tools/mesh_lobes/volume.h"

namespace insula::case_builder {

inline constexpr int most_block_voxels = 256;  ///< along each axis

struct ScanLook {
  /// {size, spacing_mm, axes: "RAS" or as the file has it, values: {least, most}, histogram: {from, to, counts},
  ///  threshold, labels: [{label, voxels}], block: {size, to_world, bytes, scale, offset}}. labels is empty if the
  /// values are grey. The value of a voxel of the block is offset + scale * what is stored.
  Json facts;
  /// Little-endian whole numbers of block.bytes bytes with a sign (2) or without (1); x to the right fastest, then
  /// forward, then up.
  std::string block;
};

/// Throws std::invalid_argument if a value is not finite.
ScanLook look_at(const mesh_tool::NiftiVolume& volume);

/// A MetaImage file of the voxels and their place. It has no other tag, so that no person is named in it.
void write_nameless(const std::filesystem::path& file, const mesh_tool::NiftiVolume& volume);

}  // namespace insula::case_builder
