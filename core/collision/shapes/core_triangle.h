// SPDX-License-Identifier: GPL-3.0-or-later
// Closest points of a piece's core (a point, a segment or a hull) and a triangle.
#pragma once
#include <array>
#include <cmath>
#include <span>

#include "core/collision/shapes/closest.h"
#include "core/collision/shapes/gjk.h"

namespace insula {

struct CoreDistance {
  double distance = 0;  ///< of the core, unsigned, m; 0 where the two meet
  Vec3 p, c, bary;      ///< on the core; on the triangle; barycentric coordinates of c
};

/// Exact if no farther than `limit`, otherwise no more than the distance. The core has one point or more.
inline CoreDistance core_triangle(std::span<const Vec3> core, const std::array<Vec3, 3>& tri, double limit) {
  CoreDistance r;
  if (core.size() <= 2) {
    const ClosestPair q = core.size() == 1 ? point_triangle(core[0], tri[0], tri[1], tri[2])
                                           : segment_triangle(core[0], core[1], tri[0], tri[1], tri[2]);
    r.distance = std::sqrt(q.distance2);
    r.p = q.p;
    r.c = q.c;
    r.bary = q.bary;
    return r;
  }
  const HullDistance d = hull_distance(core, tri, limit);
  r.distance = d.distance;
  r.p = d.a;
  r.c = d.b;
  r.bary.setZero();
  for (int k = 0; k < d.count; ++k) r.bary[d.index[k]] += d.weight[k];
  return r;
}

}  // namespace insula
