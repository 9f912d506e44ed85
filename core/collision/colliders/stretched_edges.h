// SPDX-License-Identifier: GPL-3.0-or-later
// Points within the edges of a wall that are drawn out, so that what touches vertices alone also meets such edges.
//
// An edge is stretched when it is longer than `ratio` times its length at rest, or than that multiple of the mean edge,
// whichever is more. It then gets the point at its middle. From twice this length on it also gets the points at its
// quarters, and from four times on those at its eighths. Two neighbouring points are thus never farther apart than
// `ratio` times the rest length, up to a stretch of eight times that. A point keeps its number as long as its edge is
// that long.
#pragma once
#include <array>
#include <span>
#include <vector>

#include "core/collision/search/collision_mesh.h"

namespace insula {

class StretchedEdges {
 public:
  static constexpr double ratio = 1.75;
  static constexpr int per_edge = 7;  ///< largest number of points of an edge

  /// rest: vertices, for as long as this object exists, m.
  StretchedEdges(std::span<const Vec3> rest, std::span<const std::array<int, 3>> triangles);
  /// Appends the numbers of the points in a triangle's edges, at the start of the step. Neighbouring triangles append
  /// the same numbers.
  void append_points(const CollisionMesh& mesh, int triangle, std::vector<int>& out) const;

  struct Place {
    int triangle;
    Vec3 bary;
  };
  static Place place(int point);

 private:
  std::span<const Vec3> rest_;
  double least2_ = 0;  ///< squared length of the shortest edge that may be stretched, m2
};

}  // namespace insula
