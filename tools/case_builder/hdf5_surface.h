// SPDX-License-Identifier: GPL-3.0-or-later
// Surfaces from meshes in HDF5 files, as FEniCS and what is built on it (VaMPy, Oasis, turtleFSI) write them.
#pragma once
#include <filesystem>

#include "core/model/mesh.h"

namespace insula::case_builder {

/// The group /mesh, or the first that holds points (`coordinates` or `geometry`, three numbers a row) beside `topology`
/// (three points of a triangle, four or ten of a tetrahedron a row). Of tetrahedra the outer surface, in the file's
/// unit. What is read lies in the file itself: links to others are refused, and no plugins are loaded. Throws
/// InputError: no HDF5 file, no such group, too large, or values that are out of range.
TriMesh read_hdf5_surface(const std::filesystem::path& file);

}  // namespace insula::case_builder
