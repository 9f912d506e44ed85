// SPDX-License-Identifier: GPL-3.0-or-later
// Plain tetrahedral and triangle meshes, their quality figures, and the writers of .msh and .ply.
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "volume.h"

namespace insula::mesh_tool {

using Tet = std::array<int, 4>;
using Triangle = std::array<int, 3>;

// Positively oriented: det(p1 - p0, p2 - p0, p3 - p0) > 0. Millimetres.
struct TetMesh {
  std::vector<Vec3> points;
  std::vector<Tet> tets;
};

// Normals point outward (counter-clockwise seen from outside). Millimetres.
struct TriangleMesh {
  std::vector<Vec3> points;
  std::vector<Triangle> triangles;
};

struct DihedralRange {
  double min_deg = 180;
  double max_deg = 0;
};

// The six dihedral angles of a tetrahedron, degrees; a flat or inverted one gives a negative minimum.
DihedralRange dihedral_range(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d);
DihedralRange dihedral_range(const TetMesh& mesh);

double volume(const TetMesh& mesh);
double signed_volume(const TriangleMesh& mesh);

// Boundary triangles, outward, in a fixed order; indices into the tetrahedral mesh's points.
std::vector<Triangle> boundary_triangles(const TetMesh& mesh);

// True when each directed edge occurs once and its opposite once.
bool is_closed(const std::vector<Triangle>& triangles);

// Keeps the largest set of triangles joined by edges, drops unused points; says how many triangles went.
std::size_t keep_largest_component(TriangleMesh& mesh);

// Keeps the largest set of tetrahedra joined by faces, drops unused points; says how many tetrahedra went.
std::size_t keep_largest_component(TetMesh& mesh);

// Drops points that no tetrahedron uses and numbers the rest in the order of use.
void drop_unused_points(TetMesh& mesh);

enum class MshFormat { v2_ascii, v4_ascii, v4_binary };

void write_msh(const std::string& path, const TetMesh& mesh, MshFormat format);
void write_ply(const std::string& path, const TriangleMesh& mesh);  // binary little endian, float32, with normals

}  // namespace insula::mesh_tool
