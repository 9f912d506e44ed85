// SPDX-License-Identifier: GPL-3.0-or-later
// Triangle surfaces from VTK XML PolyData, .vtp, as 3D Slicer, ParaView and VMTK write them.
#pragma once
#include <filesystem>

#include "core/model/mesh.h"

namespace insula::case_builder {

/// Polygons are cut into triangles, strips too; lines and points are left out. Coordinates as they stand. Throws
/// InputError: truncated, malformed, compressed otherwise than by zlib, an index out of range, not finite, no
/// triangles.
TriMesh read_vtp(const std::filesystem::path& file);

}  // namespace insula::case_builder
