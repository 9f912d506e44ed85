// SPDX-License-Identifier: GPL-3.0-or-later
// Random convex pairs as in collision detection, and Bullet's answer for them.
#pragma once
#include <BulletCollision/CollisionShapes/btConvexHullShape.h>
#include <BulletCollision/NarrowPhaseCollision/btGjkEpa2.h>

#include <algorithm>
#include <cmath>
#include <span>
#include <vector>

#include "core/base/math.h"
#include "core/base/random.h"

namespace insula::bullet {

static_assert(sizeof(btScalar) == sizeof(double), "Bullet's double precision variant is wanted");

/// Bullet's tolerances are absolute lengths of 1e-12; coordinates reach it in units of this, so that pieces are of the
/// order of 1.
inline constexpr double unit = 0.01;  // m

struct Pair {
  std::vector<Vec3> a, b;  ///< points of the two cores, m
  double radius = 0;       ///< of the first, m: a sphere, a capsule, a rounded hull
};

inline Vec3 any(Random& random, double size) {
  return size * Vec3(random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-1, 1));
}

/// Points around a middle, in a box of random extents, which may be flat or long.
inline std::vector<Vec3> cloud(Random& random, int count, double size, const Vec3& middle) {
  const Vec3 extent = size * Vec3(random.uniform(0.05, 1), random.uniform(0.05, 1), random.uniform(0.05, 1));
  const Quat turn = from_rotation_vector(any(random, 3));
  std::vector<Vec3> out;
  for (int i = 0; i < count; ++i) out.push_back(middle + turn * any(random, 1).cwiseProduct(extent));
  return out;
}

/// kind 0 to 5: a sphere, a capsule or a rounded hull against a triangle or a hull. Sizes from a tenth of a millimetre
/// to two centimetres.
inline Pair random_pair(Random& random, int kind) {
  Pair p;
  const double a = 1e-4 * std::pow(200.0, random.uniform()), b = 1e-4 * std::pow(200.0, random.uniform());
  const int core = kind % 3 == 0 ? 1 : kind % 3 == 1 ? 2 : 4 + int(random.below(21));
  p.a = cloud(random, core, a, Vec3::Zero());
  p.b = cloud(random, kind < 3 ? 3 : 4 + int(random.below(21)), b, any(random, 1.5 * (a + b)));
  p.radius = random.uniform(0, 1e-3);
  return p;
}

inline btVector3 scaled(const Vec3& x) { return {x.x() / unit, x.y() / unit, x.z() / unit}; }
inline Vec3 back(const btVector3& x) { return unit * Vec3(x.x(), x.y(), x.z()); }

inline btConvexHullShape hull(std::span<const Vec3> points) {
  btConvexHullShape shape;
  for (const Vec3& p : points) shape.addPoint(scaled(p), false);
  shape.recalcLocalAabb();
  shape.setMargin(0);
  return shape;
}

struct Answer {
  bool meet = false;
  double distance = 0;  ///< m; negative: depth, when they meet
  Vec3 a = Vec3::Zero(), b = Vec3::Zero();
};

inline Answer distance(const btConvexHullShape& a, const btConvexHullShape& b, const btVector3& guess) {
  const btTransform here = btTransform::getIdentity();
  btGjkEpaSolver2::sResults r;
  Answer out;
  out.meet = !btGjkEpaSolver2::Distance(&a, here, &b, here, guess, r);
  if (!out.meet) {
    out.distance = unit * r.distance;
    out.a = back(r.witnesses[0]);
    out.b = back(r.witnesses[1]);
  }
  return out;
}

/// Depth by EPA and the direction of separation, from b to a. False if EPA fails.
inline bool depth(const btConvexHullShape& a, const btConvexHullShape& b, const btVector3& guess, double& out,
                  Vec3& direction) {
  const btTransform here = btTransform::getIdentity();
  btGjkEpaSolver2::sResults r;
  if (!btGjkEpaSolver2::Penetration(&a, here, &b, here, guess, r, false)) return false;
  out = -unit * r.distance;
  direction = Vec3(r.normal.x(), r.normal.y(), r.normal.z());
  return true;
}

/// Separation of the pair along a unit direction from b to a, m. It is a lower bound of the distance, which the best
/// direction attains.
inline double apart(const Pair& p, const Vec3& n) {
  double low = n.dot(p.a[0]), high = n.dot(p.b[0]);
  for (const Vec3& x : p.a) low = std::min(low, n.dot(x));
  for (const Vec3& x : p.b) high = std::max(high, n.dot(x));
  return low - high;
}

}  // namespace insula::bullet
