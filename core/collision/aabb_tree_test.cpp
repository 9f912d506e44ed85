// SPDX-License-Identifier: GPL-3.0-or-later
// The tree's answers against looking at every triangle.
#include "core/collision/aabb_tree.h"

#include <gtest/gtest.h>

#include <set>

#include "core/collision/collision_mesh.h"
#include "core/collision/shapes_for_test.h"

namespace insula {
namespace {

using shapes::Random;

Aabb box_of(const TriMesh& m, int t) {
  Aabb b;
  for (int v : m.triangles[std::size_t(t)]) b.add(m.vertices[std::size_t(v)]);
  return b;
}

TEST(AabbTree, QueriesEqualBruteForceAlsoAfterDeformation) {
  TriMesh m = shapes::sphere(Vec3(0.1, 0, 0), 0.03, 4);
  AabbTree tree;
  tree.build(m.vertices, m.triangles);
  EXPECT_EQ(tree.triangle_count(), int(m.triangles.size()));
  Random r(1);
  for (int round = 0; round < 3; ++round) {
    if (round > 0) {
      for (Vec3& v : m.vertices) v += Vec3(0.01 * std::sin(100 * v.y()), 0.3 * v.x() * v.z(), 0.002 * round);
      tree.refit(m.vertices, {});
    }
    for (int k = 0; k < 200; ++k) {
      Aabb box;
      const Vec3 at = Vec3(0.1, 0, 0) + r.in_box(0.05);
      box.add(at);
      box.inflate(r.between(0, 0.01));
      std::set<int> found;
      tree.overlapping(box, [&](int t) { EXPECT_TRUE(found.insert(t).second); });
      for (int t = 0; t < int(m.triangles.size()); ++t)
        if (box_of(m, t).overlaps(box)) { EXPECT_TRUE(found.count(t)); }
      EXPECT_LT(found.size(), m.triangles.size());

      double best = 1e300, bound = 1e300;
      for (const auto& t : m.triangles)
        best = std::min(best, point_triangle(at, m.vertices[std::size_t(t[0])], m.vertices[std::size_t(t[1])], m.vertices[std::size_t(t[2])]).distance2);
      int visited = 0;
      tree.nearest(at, bound, [&](int i, double& limit) {
        const auto& t = m.triangles[std::size_t(i)];
        limit = std::min(limit, point_triangle(at, m.vertices[std::size_t(t[0])], m.vertices[std::size_t(t[1])], m.vertices[std::size_t(t[2])]).distance2);
        ++visited;
      });
      EXPECT_EQ(bound, best);
      EXPECT_LT(visited, int(m.triangles.size()) / 4);
    }
  }
}

TEST(AabbTree, SweptBoxesHoldBothEnds) {
  const TriMesh m = shapes::box(Vec3(0, 0, 0), Vec3(0.01, 0.01, 0.01), 3);
  std::vector<Vec3> move(m.vertices.size(), Vec3(0.1, 0, 0));
  AabbTree tree;
  tree.build(m.vertices, m.triangles);
  tree.refit(m.vertices, move);
  EXPECT_NEAR(tree.bounds().low[0], 0, 1e-15);
  EXPECT_NEAR(tree.bounds().high[0], 0.11, 1e-15);
}

TEST(AabbTree, EmptyMesh) {
  AabbTree tree;
  tree.build({}, {});
  EXPECT_TRUE(tree.empty());
  tree.refit({}, {});
  Aabb all;
  all.add(Vec3::Zero());
  tree.overlapping(all, [](int) { FAIL(); });
}

TEST(CollisionMesh, PseudoNormalsTellInsideFromOutsideOfABox) {
  const TriMesh m = shapes::box(Vec3(-1, -1, -1), Vec3(1, 1, 1), 2);
  CollisionMesh mesh;
  mesh.build(m.vertices, m.triangles);
  mesh.update(m.vertices, {});
  Random r(7);
  for (int k = 0; k < 2000; ++k) {
    const Vec3 p = r.in_box(1.6);
    double least = 1e300;
    int tri = -1;
    ClosestPair best;
    for (int t = 0; t < mesh.triangle_count(); ++t) {
      const auto& v = mesh.triangle(t);
      const ClosestPair q = point_triangle(p, mesh.vertex(v[0]), mesh.vertex(v[1]), mesh.vertex(v[2]));
      if (q.distance2 < least) {
        least = q.distance2;
        tri = t;
        best = q;
      }
    }
    const bool outside = p.cwiseAbs().maxCoeff() > 1;
    const TriangleFeature f = feature_of(best.bary);
    EXPECT_EQ((p - best.c).dot(mesh.pseudo_normal(tri, f)) > 0, outside);
    EXPECT_TRUE(mesh.locally_closest(tri, f, (p - best.c).normalized(), 0, 1e-9));
  }
}

}  // namespace
}  // namespace insula
