// SPDX-License-Identifier: GPL-3.0-or-later
// Adjacency of a wall's triangles, and parts of a wall about points of it: a plaque, a thin spot.
#pragma once
#include <array>
#include <string>
#include <string_view>
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

/// Reads "12 3 4 mm; 12.5 3 4 mm", m. `wrong` gets the reason if a point is none; the points are then incomplete.
std::vector<Vec3> read_spots(std::string_view text, std::string& wrong);

/// One flag a triangle: whether it is of a spot. A spot begins with the triangle that is nearest to its point and grows
/// over edges to triangles whose middles are within `radius` of the point, m. It thus stays on its side of a vessel.
/// `wrong` gets the reason if a point is farther than `radius` from the wall.
std::vector<char> spot_triangles(const WallTopology& wall, const std::vector<Vec3>& nodes,
                                 const std::vector<Vec3>& spots, double radius, std::string& wrong);

}  // namespace insula
