// SPDX-License-Identifier: GPL-3.0-or-later
// Distance of two convex hulls of few points (Gilbert, Johnson, Keerthi 1988). It is a pure function without state. It
// does not compute penetration depth. Against a surface, the direction of separation follows from the surface's outward
// normals, which the smallest translation out of a single triangle does not contain.
#pragma once
#include <limits>
#include <span>

#include "core/base/math.h"

namespace insula {

struct HullDistance {
  double distance = 0;    ///< 0 when the hulls meet
  Vec3 a = Vec3::Zero();  ///< closest point of the first hull (a common point when they meet)
  Vec3 b = Vec3::Zero();  ///< closest point of the second
  int count = 0;          ///< number of points of the second hull that b is a weighted sum of
  int index[4] = {0, 0, 0, 0};
  double weight[4] = {0, 0, 0, 0};
};

/// Each span holds at least one point (scene frame, m). The relative accuracy is about 1e-10 of the distance for hulls
/// of ordinary size. Stops after at most 64 iterations with the best pair found. For hulls farther apart than `limit`
/// the search ends early. `distance` is then a bound between the limit and their distance, and the two points are
/// points of the hulls.
HullDistance hull_distance(std::span<const Vec3> a, std::span<const Vec3> b,
                           double limit = std::numeric_limits<double>::infinity());

}  // namespace insula
