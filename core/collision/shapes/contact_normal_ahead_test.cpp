// SPDX-License-Identifier: GPL-3.0-or-later
// Where a piece is nearest to a surface that has gone on: on its faces, past an edge, and not from within.
#include "core/collision/shapes/contact_normal_ahead.h"

#include <gtest/gtest.h>

#include "core/collision/shapes/shapes_for_test.h"

namespace insula {
namespace {

constexpr double radius = 1e-3, half = 10e-3;

struct Rig {
  TriMesh box;
  CollisionMesh mesh;
  RoundedPiece ball = rounded({"ball", {Vec3::Zero()}, radius});
  Vec3 gone = Vec3::Zero();  ///< of the surface
  explicit Rig(TriMesh surface = shapes::box(Vec3::Constant(-half), Vec3::Constant(half), 8))
      : box(std::move(surface)) {
    mesh.build(box.vertices, box.triangles);
    mesh.update(box.vertices, {});
  }
  std::optional<Vec3> nearest(const Vec3& centre, const Vec3& like = Vec3::Zero()) const {
    Pose pose;
    pose.p = centre;
    return contact_normal_ahead(
        ball, pose, mesh, [&](int v) { return Vec3(box.vertices[std::size_t(v)] + gone); }, centre, 3 * radius, like);
  }
};

TEST(ContactNormalAhead, TheNormalLeadsFromTheSurfaceToThePiece) {
  Rig rig;
  std::optional<Vec3> normal;
  ASSERT_TRUE((normal = rig.nearest(Vec3(1.3e-3, 0.4e-3, half + radius))));
  EXPECT_LT((*normal - Vec3::UnitZ()).norm(), 1e-12);
  // Beyond the edge between two faces, at any angle: from the edge to the ball's middle.
  for (const double angle : {0.1, 0.6, 1.4}) {
    const Vec3 out(std::sin(angle), 0, std::cos(angle));
    ASSERT_TRUE((normal = rig.nearest(Vec3(half, 0.7e-3, half) + radius * out)));
    EXPECT_LT((*normal - out).norm(), 1e-9) << angle;
  }
  ASSERT_TRUE((normal = rig.nearest(Vec3(half + radius, 0.7e-3, 0))));
  EXPECT_LT((*normal - Vec3::UnitX()).norm(), 1e-12);
}

TEST(ContactNormalAhead, TheSurfaceIsWhereItHasGone) {
  Rig rig;
  rig.gone = Vec3(-0.5e-3, 0, 0);
  const Vec3 out = Vec3(1, 0, 1).normalized();
  std::optional<Vec3> normal;
  ASSERT_TRUE((normal = rig.nearest(Vec3(half, 0.7e-3, half) + rig.gone + radius * out)));
  EXPECT_LT((*normal - out).norm(), 1e-9);
}

// Two boxes side by side with a step between them: in its corner each contact keeps its own wall.
TEST(ContactNormalAhead, InAGrooveEachContactKeepsItsWall) {
  const Rig rig(shapes::joined(shapes::box(Vec3(-half, -half, -half), Vec3(0, half, half), 8),
                               shapes::box(Vec3(0, -half, -half), Vec3(half, half, 0), 8)));
  const Vec3 corner(radius, 0.7e-3, radius);
  for (const Vec3& wall : {Vec3(Vec3::UnitX()), Vec3(Vec3::UnitZ())}) {
    const auto normal = rig.nearest(corner, wall);
    ASSERT_TRUE(normal);
    EXPECT_LT((*normal - wall).norm(), 1e-12);
  }
}

TEST(ContactNormalAhead, NotFromWithinNorFromFarAway) {
  Rig rig;
  EXPECT_FALSE(rig.nearest(Vec3(0.3e-3, 0.2e-3, half - 0.2e-3)));
  EXPECT_FALSE(rig.nearest(Vec3(0, 0, half + 5 * radius)));
}

}  // namespace
}  // namespace insula
