// SPDX-License-Identifier: GPL-3.0-or-later
// The tree's answers against looking at every triangle.
#include "core/collision/search/aabb_tree.h"

#include <gtest/gtest.h>

#include <cmath>
#include <set>

#include "core/collision/search/collision_mesh.h"
#include "core/collision/shapes/shapes_for_test.h"

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
        if (box_of(m, t).overlaps(box)) {
          EXPECT_TRUE(found.count(t));
        }
      EXPECT_LT(found.size(), m.triangles.size());

      double best = 1e300, bound = 1e300;
      for (const auto& t : m.triangles)
        best = std::min(best, point_triangle(at, m.vertices[std::size_t(t[0])], m.vertices[std::size_t(t[1])],
                                             m.vertices[std::size_t(t[2])])
                                  .distance2);
      int visited = 0;
      tree.nearest(at, bound, [&](int i, double& limit) {
        const auto& t = m.triangles[std::size_t(i)];
        limit = std::min(limit, point_triangle(at, m.vertices[std::size_t(t[0])], m.vertices[std::size_t(t[1])],
                                               m.vertices[std::size_t(t[2])])
                                    .distance2);
        ++visited;
      });
      EXPECT_EQ(bound, best);
      EXPECT_LT(visited, int(m.triangles.size()) / 4);
    }
  }
}

// Boxes are loose and made in passing; what is found is as if the tree were new.
TEST(AabbTree, WhatIsFoundDoesNotDependOnWhatWasBefore) {
  TriMesh m = shapes::sphere(Vec3(0.1, 0, 0), 0.03, 3);
  AabbTree tree, fresh;
  tree.build(m.vertices, m.triangles);
  fresh.build(m.vertices, m.triangles);
  Random r(3);
  const std::vector<Vec3> none(m.vertices.size(), Vec3(Vec3::Zero()));
  int found = 0;
  for (int round = 0; round < 300; ++round) {
    // Half of it stands still; here and there something goes far.
    for (Vec3& v : m.vertices)
      if (v.z() > 0) v += r.in_box(r.between(0, 1) < 0.01 ? 2e-3 : 3e-5);
    tree.refit(m.vertices, none);
    // Everything goes far and comes back: nothing of the old boxes is left.
    std::vector<Vec3> off = m.vertices;
    for (Vec3& v : off) v += Vec3(1, 1, 1);
    fresh.refit(off, none);
    fresh.refit(m.vertices, none);
    for (int k = 0; k < 20; ++k) {
      Aabb box;
      box.add(Vec3(Vec3(0.1, 0, 0) + r.in_box(0.04)));
      box.inflate(r.between(0, 0.01));
      std::vector<int> a, b;
      tree.overlapping(box, [&](int t) { a.push_back(t); });
      fresh.overlapping(box, [&](int t) { b.push_back(t); });
      ASSERT_EQ(a, b);
      found += int(a.size());
      for (int t : a) ASSERT_TRUE(tree.any_overlapping(box)) << t;
    }
  }
  EXPECT_GT(found, 10000);
}

TEST(AabbTree, SweptBoxesHoldBothEnds) {
  const TriMesh m = shapes::box(Vec3(0, 0, 0), Vec3(0.01, 0.01, 0.01), 3);
  std::vector<Vec3> move(m.vertices.size(), Vec3(0.1, 0, 0));
  AabbTree tree;
  tree.build(m.vertices, m.triangles);
  tree.refit(m.vertices, move);
  const Aabb all = tree.bounds();
  EXPECT_LE(all.low[0], 0);
  EXPECT_GE(all.high[0], 0.11);
  EXPECT_NEAR(all.low[0], 0, 1.01 * AabbTree::slack);
  EXPECT_NEAR(all.high[0], 0.11, 1.01 * AabbTree::slack);
}

TEST(AabbTree, BoxesInSinglePrecisionHoldWhatTheyAreMadeOf) {
  Random r(5);
  for (int k = 0; k < 20000; ++k) {
    Aabb box;
    const double size = std::pow(10.0, r.between(-6, 1));
    box.add(r.in_box(size));
    box.add(r.in_box(size));
    const OuterBox outer = OuterBox::around(box);
    for (int i = 0; i < 3; ++i) {
      EXPECT_LE(double(outer.low[i]), box.low[i]);
      EXPECT_GE(double(outer.high[i]), box.high[i]);
      EXPECT_LE(box.low[i] - double(outer.low[i]), 2.5e-7 * size);
    }
    Vec3 p = r.in_box(2 * size);
    EXPECT_LE(outer.distance2(p), box.distance2(p));
    // Boxes that share no more than a face still overlap.
    Aabb next = box;
    next.low[0] = box.high[0];
    next.high[0] = box.high[0] + size;
    EXPECT_TRUE(outer.overlaps(OuterBox::around(next)));
    next.low[0] += 1e-5 * size;
    EXPECT_FALSE(outer.overlaps(OuterBox::around(next)));
  }
}

TEST(AabbTree, MarksNearABoxAreThoseOfItsLeavesAndTheNearestUnknownOneIsTold) {
  const TriMesh m = shapes::sphere(Vec3(0.1, 0, 0), 0.03, 4);
  CollisionMesh mesh;
  mesh.build(m.vertices, m.triangles);
  mesh.update(m.vertices, {});
  Random r(8);
  for (int k = 0; k < 300; ++k) {
    Aabb box;
    box.add(Vec3(Vec3(0.1, 0, 0) + r.in_box(0.05)));
    const double within = r.between(0, 0.02);
    const std::uint64_t known = std::uint64_t(r.between(0, 1e18)) * 18;
    std::uint64_t expected = 0;
    double nearest = 1, other = 1;
    Aabb wide = box;
    wide.inflate(within);
    mesh.tree().leaves(wide, [&](const OuterBox& leaf, std::span<const int> triangles) {
      std::uint64_t marks = 0;
      for (int t : triangles) marks |= mesh.regions_of(t);
      expected |= marks;
      if ((marks & ~known) != 0) nearest = std::min(nearest, std::sqrt(leaf.distance2(box)));
    });
    EXPECT_EQ(mesh.regions_near(box, within, known, other), expected);
    EXPECT_EQ(other, nearest);
  }
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
