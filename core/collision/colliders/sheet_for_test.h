// SPDX-License-Identifier: GPL-3.0-or-later
// A flat square sheet as a collision mesh and a box as a piece of a tool, for tests of colliders.
#pragma once
#include <array>
#include <vector>

#include "core/collision/search/collision_mesh.h"
#include "core/model/tools/tool_model.h"

namespace insula::test {

/// In z = 0, n x n vertices `spacing` apart (m), centred. update() takes what was changed in `now` and `free`.
struct Sheet {
  std::vector<Vec3> rest, now, free;
  std::vector<std::array<int, 3>> triangles;
  CollisionMesh mesh;
  explicit Sheet(int n = 21, double spacing = 0.25e-3) {
    for (int j = 0; j < n; ++j)
      for (int i = 0; i < n; ++i) rest.push_back(spacing * Vec3(i - 0.5 * (n - 1), j - 0.5 * (n - 1), 0));
    for (int j = 0; j + 1 < n; ++j)
      for (int i = 0; i + 1 < n; ++i) {
        const int a = j * n + i;
        triangles.push_back({a, a + 1, a + n + 1});
        triangles.push_back({a, a + n + 1, a + n});
      }
    now = rest;
    free.assign(rest.size(), Vec3::Zero());
    mesh.build(rest, triangles);
    update();
  }
  void update() { mesh.update(now, free); }
  int count() const { return int(rest.size()); }
};

/// Centred, aligned with the axes; half its extents, m.
inline ConvexPiece box_piece(double half_x, double half_y, double half_z) {
  ConvexPiece p{"box", {}, 0};
  for (int i = 0; i < 8; ++i)
    p.points.push_back({i & 1 ? half_x : -half_x, i & 2 ? half_y : -half_y, i & 4 ? half_z : -half_z});
  return p;
}

}  // namespace insula::test
