// SPDX-License-Identifier: GPL-3.0-or-later
// Pushes tetrahedral parts apart and lifts the worst dihedral angles.
#pragma once

#include <vector>

#include "mesh_data.h"

namespace insula::mesh_tool {

// Moves vertices while tetrahedra have an angle below `target_deg`: interior vertices freely, boundary vertices never
// outward and at most `boundary_shift` (mm) in all. Hill climbing with a fixed sequence of directions. Tetrahedra on
// the boundary that stay below are removed when that leaves the boundary closed. Returns the smallest angle reached.
double improve_dihedral(TetMesh& mesh, double target_deg, double boundary_shift);

// Pushes boundary vertices inward until samples (15 a triangle) of the boundaries of two different parts are
// `gap` (mm) apart, or the rounds are used up. Returns the smallest distance reached (negative: inside).
double separate_parts(std::vector<TetMesh>& parts, double gap, int rounds);

// Pulls boundary vertices outward towards the given points that lie more than `allowed` (mm) outside the mesh.
void reach_out(TetMesh& mesh, const std::vector<Vec3>& points, double allowed, int rounds);

// Smallest distance between two closed surfaces by dense sampling of both (mm), and whether any triangles intersect.
struct Clearance {
  double distance = 0;
  bool intersect = false;
};
Clearance clearance(const TriangleMesh& a, const TriangleMesh& b);

// Largest distance (mm) of a surface's vertices outside a tetrahedral mesh, and the share of vertices outside.
struct Embedding {
  double furthest = 0;
  double share_outside = 0;
};
Embedding embedding(const TriangleMesh& surface, const TetMesh& volume);

// The points of the mesh with its boundary triangles.
TriangleMesh boundary_mesh(const TetMesh& mesh);

}  // namespace insula::mesh_tool
