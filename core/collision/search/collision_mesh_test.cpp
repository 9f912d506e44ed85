// SPDX-License-Identifier: GPL-3.0-or-later
// A mesh whose motion is followed by region: its boxes hold it all the time, however it moves and whoever measures
// that.
#include "core/collision/search/collision_mesh.h"

#include <gtest/gtest.h>

#include <cmath>

#include "core/collision/shapes/shapes_for_test.h"

namespace insula {
namespace {

RegionMotion measured(const CollisionMesh& mesh, const std::vector<Vec3>& before, const std::vector<Vec3>& now,
                      const std::vector<Vec3>& free) {
  RegionMotion m;
  for (std::size_t v = 0; v < now.size(); ++v) {
    const std::size_t r = std::size_t(std::countr_zero(mesh.region_of(int(v))));
    m.moved[r] = std::max(m.moved[r], (now[v] - before[v]).norm());
    m.may_move[r] = std::max(m.may_move[r], free[v].norm());
  }
  return m;
}

// Vertices that a leaf's box does not hold.
int outside(const CollisionMesh& mesh) {
  int n = 0, leaves = 0;
  Aabb everywhere;
  everywhere.low.setConstant(-1e3);
  everywhere.high.setConstant(1e3);
  mesh.tree().leaves(everywhere, [&](const OuterBox& box, std::span<const int> triangles) {
    ++leaves;
    for (int t : triangles)
      for (int v : mesh.triangle(t)) n += box.distance2(mesh.vertex(v)) > 0 || box.distance2(mesh.vertex(v, 1)) > 0;
  });
  EXPECT_GT(leaves, 0);
  return n;
}

struct SquareSheet {
  TriMesh rest = shapes::sphere(Vec3(0.1, -0.2, 0.3), 0.02, 4);
  std::vector<Vec3> now = rest.vertices, before = now, free{now.size(), Vec3::Zero()};
  // Micrometres a step in most places, half a millimetre in some.
  void move(int step) {
    before = now;
    for (std::size_t v = 0; v < now.size(); ++v) {
      const Vec3& x = rest.vertices[v];
      const double wide = 1e-3 * std::sin(0.002 * step + 40 * x.x()),
                   narrow = 2e-3 * std::sin(0.25 * step) * std::exp(-std::pow((x.y() + 0.2) / 3e-3, 2));
      now[v] = x + Vec3(wide, -wide, narrow);
      free[v] = 1.3 * (now[v] - before[v]);
    }
  }
};

TEST(CollisionMesh, BoxesHoldWhatMovesInTheirRoom) {
  SquareSheet s;
  CollisionMesh told, measures;
  told.build(s.rest.vertices, s.rest.triangles);
  measures.build(s.rest.vertices, s.rest.triangles);
  for (int step = 0; step < 400; ++step) {
    s.move(step);
    const RegionMotion m = measured(told, s.before, s.now, s.free);
    told.update(s.now, s.free, m);
    measures.update(s.now, s.free);
    ASSERT_EQ(outside(told), 0) << step;
    ASSERT_EQ(outside(measures), 0) << step;
    if (step == 0) continue;  // from rest to there was measured by one of them only
    for (int r = 0; r < CollisionMesh::regions; ++r) {
      const std::uint64_t mask = std::uint64_t(1) << r;
      ASSERT_NEAR(told.moved(mask), measures.moved(mask), 1e-15);
      ASSERT_NEAR(told.may_move(mask), measures.may_move(mask), 1e-15);
    }
  }
}

TEST(CollisionMesh, NoticesAJumpThatWasNotMeasured) {
  SquareSheet s;
  CollisionMesh mesh;
  mesh.build(s.rest.vertices, s.rest.triangles);
  for (int step = 0; step < 10; ++step) {
    s.move(step);
    mesh.update(s.now, s.free, measured(mesh, s.before, s.now, s.free));
  }
  const double travelled = mesh.travelled();
  mesh.keep_positions();
  for (Vec3& x : s.now) x += Vec3(0.02, 0, 0);
  mesh.keep_positions();
  for (Vec3& x : s.now) x += Vec3(0.02, 0, 0);
  mesh.update(s.now, s.free, RegionMotion{});
  EXPECT_EQ(outside(mesh), 0);
  EXPECT_NEAR(mesh.travelled() - travelled, 0.04, 1e-12);
  // From one that measures for the mesh to one that leaves it to it.
  mesh.update(s.now, s.free, RegionMotion{});
  const long before = mesh.updates();
  for (Vec3& x : s.now) x += Vec3(0.02, 0, 0);
  mesh.update(s.now, s.free);
  EXPECT_EQ(outside(mesh), 0);
  EXPECT_GT(mesh.updates() - before, 1) << "who keeps what it knows must hear of it";
}

}  // namespace
}  // namespace insula
