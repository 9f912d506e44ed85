// SPDX-License-Identifier: GPL-3.0-or-later
// Closed triangle meshes of the URDF primitives.
#include "core/model/tools/primitive_mesh.h"

#include <cmath>
#include <numbers>

namespace insula {
namespace {

/// Rings of `sides` points at (radius, height) each, between two poles on the axis.
TriMesh turned(const std::vector<std::array<double, 2>>& rings, double bottom, double top, int sides) {
  TriMesh mesh;
  mesh.vertices.emplace_back(0, 0, bottom);
  for (const auto& [radius, height] : rings)
    for (int k = 0; k < sides; ++k) {
      const double angle = 2 * std::numbers::pi * k / sides;
      mesh.vertices.emplace_back(radius * std::cos(angle), radius * std::sin(angle), height);
    }
  const int last = int(mesh.vertices.size());
  mesh.vertices.emplace_back(0, 0, top);
  const auto at = [&](int ring, int k) { return 1 + ring * sides + k % sides; };
  const int n = int(rings.size());
  for (int k = 0; k < sides; ++k) {
    mesh.triangles.push_back({0, at(0, k + 1), at(0, k)});
    for (int r = 0; r + 1 < n; ++r) {
      mesh.triangles.push_back({at(r, k), at(r, k + 1), at(r + 1, k + 1)});
      mesh.triangles.push_back({at(r, k), at(r + 1, k + 1), at(r + 1, k)});
    }
    mesh.triangles.push_back({last, at(n - 1, k), at(n - 1, k + 1)});
  }
  return mesh;
}

}  // namespace

TriMesh box_mesh(const Vec3& size) {
  TriMesh mesh;
  for (int i = 0; i < 8; ++i)
    mesh.vertices.push_back(Vec3((i & 1) - 0.5, (i >> 1 & 1) - 0.5, (i >> 2 & 1) - 0.5).cwiseProduct(size));
  mesh.triangles = {{0, 2, 3}, {0, 3, 1}, {4, 5, 7}, {4, 7, 6}, {0, 1, 5}, {0, 5, 4},
                    {2, 6, 7}, {2, 7, 3}, {0, 4, 6}, {0, 6, 2}, {1, 3, 7}, {1, 7, 5}};
  return mesh;
}

TriMesh cylinder_mesh(double radius, double length) {
  return turned({{radius, -length / 2}, {radius, length / 2}}, -length / 2, length / 2, 32);
}

TriMesh sphere_mesh(double radius) {
  std::vector<std::array<double, 2>> rings;
  constexpr int n = 16;
  for (int i = 1; i < n; ++i) {
    const double angle = std::numbers::pi * (double(i) / n - 0.5);
    rings.push_back({radius * std::cos(angle), radius * std::sin(angle)});
  }
  return turned(rings, -radius, radius, 32);
}

}  // namespace insula
