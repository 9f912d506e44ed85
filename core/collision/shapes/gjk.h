// SPDX-License-Identifier: GPL-3.0-or-later
// Distance of two convex hulls of few points (Gilbert, Johnson, Keerthi 1988): pure, no state kept between calls.
// Penetration depth is not computed here: against a surface the way out follows from the surface's own outward normals,
// which the smallest translation out of one single triangle does not know.
#pragma once
#include <limits>
#include <span>

#include "core/base/math.h"

namespace insula {

struct HullDistance {
  double distance = 0;            ///< 0 when the hulls meet
  Vec3 a = Vec3::Zero();          ///< closest point of the first hull (a common point when they meet)
  Vec3 b = Vec3::Zero();          ///< closest point of the second
  int count = 0;                  ///< points of the second hull that b is made of
  int index[4] = {0, 0, 0, 0};
  double weight[4] = {0, 0, 0, 0};
};

/// Both spans hold at least one point, scene frame, m. Relative accuracy about 1e-10 of the distance for hulls of
/// ordinary size; stops after 64 iterations at the latest with the best pair found. Hulls that turn out to be farther apart than
/// `limit` are left at that: `distance` is then a bound between the limit and their distance, the points are two of theirs.
HullDistance hull_distance(std::span<const Vec3> a, std::span<const Vec3> b, double limit = std::numeric_limits<double>::infinity());

}  // namespace insula
