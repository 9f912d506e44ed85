// SPDX-License-Identifier: GPL-3.0-or-later
// Meshes as read from files, in metres. Readers check everything (counts, indices, finiteness) and throw InputError.
#pragma once
#include <array>
#include <filesystem>
#include <vector>

#include "core/base/math.h"

namespace insula {

struct TetMesh {
  std::vector<Vec3> nodes;               ///< m
  std::vector<std::array<int, 4>> tets;  ///< positively oriented: (b-a) x (c-a) . (d-a) > 0
};

struct TriMesh {
  std::vector<Vec3> vertices;                 ///< m
  std::vector<std::array<int, 3>> triangles;  ///< counter-clockwise from outside
};

/// Reads gmsh .msh 2.2 and 4.1 (ASCII, binary), VTK .vtk legacy, .vtu and Medit .mesh. Lengths are multiplied by
/// metres_per_unit. Nodes that no tetrahedron uses are dropped. Throws InputError: unreadable, truncated, no
/// tetrahedra, index out of range, not finite, inverted or flat tetrahedron (with its number).
TetMesh read_tet_mesh(const std::filesystem::path& file, double metres_per_unit);

/// Reads STL, OBJ, PLY, glTF and others through assimp. Joins all parts, merges equal vertices and drops flat
/// triangles. File coordinates are kept as written (no axis conversion). Throws InputError: unreadable, truncated,
/// empty, not finite.
TriMesh read_surface(const std::filesystem::path& file, double metres_per_unit);

/// Writes .vtu (ASCII or appended binary) with optional point vectors; throws InputError when it cannot be written.
void write_vtu(const std::filesystem::path& file, const std::vector<Vec3>& nodes,
               const std::vector<std::array<int, 4>>& tets, const std::vector<Vec3>& displacement);
/// The same for a surface: triangles in place of tetrahedra.
void write_vtu(const std::filesystem::path& file, const std::vector<Vec3>& nodes,
               const std::vector<std::array<int, 3>>& triangles, const std::vector<Vec3>& displacement);

/// Boundary triangles of a tetrahedral mesh, facing outward, in the order of the tetrahedra.
std::vector<std::array<int, 3>> boundary_triangles(const TetMesh& mesh);

/// Positions of points in a tetrahedral mesh: four nodes and their barycentric weights for each point. Points outside
/// take the nearest tetrahedron. Their weights are extrapolated and may be negative, but stay within [-limit, 1 +
/// limit]. `outside_m` gets the largest distance outside, m.
struct Embedding {
  std::vector<std::array<int, 4>> nodes;
  std::vector<std::array<double, 4>> weights;
  double outside_m = 0;
};
Embedding embed(const TetMesh& mesh, const std::vector<Vec3>& points);

}  // namespace insula
