// SPDX-License-Identifier: GPL-3.0-or-later
// Surfaces from VTK XML unstructured grids, .vtu, as SimVascular and VMTK write meshes for blood flow.
#pragma once
#include <filesystem>

#include "core/model/mesh.h"

namespace insula::case_builder {

/// The outer surface of the volume cells; without any, all faces. Cells of second order count with their corners. In
/// the file's unit. Throws InputError: another type, malformed, truncated, not finite, or without cells of a kind that
/// is known.
TriMesh read_vtu_surface(const std::filesystem::path& file);

}  // namespace insula::case_builder
