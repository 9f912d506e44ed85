// SPDX-License-Identifier: GPL-3.0-or-later
// A closed triangle surface whose triangles know the flat cap they belong to, and what is done to it: extraction from a
// function, cutting by planes, closing, and isotropic remeshing. Millimetres.
#pragma once
#include <array>
#include <functional>
#include <string>
#include <vector>

#include "core/model/mesh.h"

namespace insula::artery {

struct CapPlane {
  std::string name;
  Vec3 centre, normal;  ///< unit, outward
  double radius = 0;
};

struct Surface {
  TriMesh mesh;
  std::vector<int> patch;  ///< a triangle's cap, or -1 on the wall
  std::vector<CapPlane> caps;
};

/// The zero set of a function inside a box, by marching tetrahedra; closed where the set does not touch the box.
TriMesh extract(const std::function<double(const Vec3&)>& value, const Vec3& low, const Vec3& high, double step);

/// Values at the nodes low + step (i, j, k) of a grid, i fastest; negative inside.
struct NodeValues {
  Vec3 low;
  double step;
  std::array<int, 3> size;
  std::vector<double> value;
};
/// The same of values that are there.
TriMesh extract(NodeValues nodes);

/// Cuts what lies beyond the cap's plane within `reach` of its centre, and closes the opening by a fan.
void cut_and_close(Surface& surface, const CapPlane& cap, double reach);

/// Renumbers vertices in the order in which triangles first use them; unused ones go.
void number_by_use(TriMesh& mesh);

struct RemeshGuide {
  std::function<double(const Vec3&)> edge_length;    ///< wanted here
  std::function<Vec3(const Vec3&)> on_wall;          ///< nearest point of the true wall
  std::function<Vec3(int cap, const Vec3&)> on_rim;  ///< nearest point of a cap's rim
  std::function<Vec3(int cap, const Vec3&)> on_cap;  ///< nearest point of a cap's plane
};

/// Splits, collapses and flips edges and relaxes vertices until edges have the wanted length (Botsch and Kobbelt 2004),
/// then improves the smallest angles. Rims of caps stay sharp.
void remesh(Surface& surface, const RemeshGuide& guide, int rounds);

/// The vertices that a mesh with such edges would have: what scales edges to a wanted count.
double expected_vertices(const TriMesh& mesh, const std::function<double(const Vec3&)>& edge_length);

/// Every triangle into four, new vertices brought onto the true surface.
Surface subdivided(const Surface& surface, const RemeshGuide& guide);

struct Quality {
  double min_angle_deg = 0, mean_min_angle_deg = 0, shortest = 0, longest = 0;
  bool closed = false, self_intersecting = true;
  int components = 0, euler = 0;
};
Quality quality(const TriMesh& mesh);

/// -1 where the triangles about a vertex are all wall, the cap where they are all of one cap, else rim of that cap.
struct VertexKind {
  int cap = -1;
  bool rim = false;
};
std::vector<VertexKind> vertex_kinds(const Surface& surface);

}  // namespace insula::artery
