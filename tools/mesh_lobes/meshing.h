// SPDX-License-Identifier: GPL-3.0-or-later
// Delaunay meshing of level functions with CGAL's Mesh_3: closed surfaces and tetrahedra.
#pragma once

#include <functional>
#include <vector>

#include "mesh_data.h"
#include "volume.h"

namespace insula::mesh_tool {

using SizeField = std::function<double(const Vec3&)>;  // wanted edge length at a point, mm

// Both functions draw from one seeded generator and run on one thread: the same input gives the same mesh.

// Surface of {level > 0}: largest component, closed, outward. `error` bounds the distance to the level set, mm.
// Throws std::runtime_error when no closed surface comes out.
TriangleMesh mesh_surface(const Grid& grid, const Field& level, const SizeField& edge, double error);

// Tetrahedra of {level > 0}: largest component, its boundary a closed manifold; slivers are perturbed and exuded.
TetMesh mesh_volume(const Grid& grid, const Field& level, const SizeField& edge, const SizeField& error);

}  // namespace insula::mesh_tool
