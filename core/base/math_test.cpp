// SPDX-License-Identifier: GPL-3.0-or-later
// Rotation vectors, quaternions, displacements.
#include "core/base/math.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

namespace insula {
namespace {

TEST(Rotation, RoundTrip) {
  for (const Vec3& r :
       {Vec3(0, 0, 0), Vec3(1e-14, 0, 0), Vec3(0.3, -0.2, 0.9), Vec3(0, 3.1, 0), Vec3(1e-6, 2e-6, -1e-6)})
    EXPECT_LT((rotation_vector(from_rotation_vector(r)) - r).norm(), 1e-12) << r.transpose();
}

TEST(Rotation, ShortWayRound) {
  const Quat q = from_rotation_vector(Vec3(0, 0, 1.5 * std::numbers::pi));
  EXPECT_LT((rotation_vector(q) - Vec3(0, 0, -0.5 * std::numbers::pi)).norm(), 1e-12);
  const Quat minus(-q.w(), -q.x(), -q.y(), -q.z());
  EXPECT_LT((rotation_vector(minus) - rotation_vector(q)).norm(), 1e-12);
}

TEST(Rotation, QuarterTurn) {
  const Pose p{Vec3(1, 2, 3), from_rotation_vector(Vec3(0, 0, std::numbers::pi / 2))};
  EXPECT_LT((p.apply(Vec3(1, 0, 0)) - Vec3(1, 3, 3)).norm(), 1e-12);
}

TEST(Rotation, DisplacementAndBack) {
  const Pose a{Vec3(1, 2, 3), from_rotation_vector(Vec3(0.1, 0.2, 0.3))};
  const Pose b{Vec3(-1, 0, 2), from_rotation_vector(Vec3(-0.4, 1.2, 0.1))};
  const Pose c = displaced(a, displacement(a, b));
  EXPECT_LT((c.p - b.p).norm(), 1e-12);
  EXPECT_LT(c.q.angularDistance(b.q), 1e-7);
}

TEST(Skew, IsTheCrossProduct) {
  const Vec3 a(1, -2, 3), b(0.5, 4, -1);
  EXPECT_LT((skew(a) * b - a.cross(b)).norm(), 1e-15);
}

}  // namespace
}  // namespace insula
