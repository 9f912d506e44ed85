// SPDX-License-Identifier: GPL-3.0-or-later
// Adjacency of a wall's triangles.
#pragma once
#include <array>
#include <string>
#include <vector>

#include "plugins/membrane/hinge.h"

namespace insula {

struct WallTopology {
  struct Side {
    int triangle = -1, edge = -1;  ///< edge k runs from corner k to corner k + 1; its apex is corner k + 2
  };
  std::vector<std::array<int, 3>> triangles;
  std::vector<WallHinge> hinges;             ///< edges with two triangles, by their first triangle
  std::vector<std::array<Side, 2>> sides;    ///< of each hinge
  std::vector<std::array<int, 3>> hinge_of;  ///< of each edge of a triangle; -1 on a free rim

  /// Returns the error text; empty if the wall is a surface.
  std::string build(const std::vector<Vec3>& nodes, const std::vector<std::array<int, 3>>& wall);
};

}  // namespace insula
