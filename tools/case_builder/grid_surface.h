// SPDX-License-Identifier: GPL-3.0-or-later
// Surfaces out of volumes, and out of surfaces that are too broken to be mended triangle by triangle. Millimetres.
#pragma once
#include "core/model/mesh.h"
#include "tools/case_builder/case_folder.h"
#include "tools/mesh_lobes/volume.h"

namespace insula::case_builder {

/// The surface of the vessel in a volume of labels or of grey values, closed. `ends` gets a plane for each place where
/// the vessel leaves the volume: there it is to be cut straight. Throws InputError: no such label (those that exist are
/// named), nothing above the threshold, voxels of an implausible size.
TriMesh surface_of_volume(const std::filesystem::path& file, const mesh_tool::NiftiVolume& volume,
                          const Options& options, std::vector<Note>& notes, std::vector<Plane>& ends);

/// Nodes of a grid around which an odd number of walls lies, by two of the three axes; the surface may reach beyond the
/// grid.
mesh_tool::Mask inside_of(const TriMesh& mesh, const mesh_tool::Grid& grid);

/// A closed surface without handles, made anew from a grid of that spacing: what an odd number of walls lies around is
/// inside.
TriMesh rebuilt(const TriMesh& mesh, double spacing, std::vector<Note>& notes);

}  // namespace insula::case_builder
