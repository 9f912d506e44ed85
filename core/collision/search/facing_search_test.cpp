// SPDX-License-Identifier: GPL-3.0-or-later
// What is kept from step to step spares looks and changes nothing: the nearest facing triangle is that of a search of
// all.
#include "core/collision/search/facing_search.h"

#include <gtest/gtest.h>

#include <cmath>

#include "core/collision/shapes/shapes_for_test.h"

namespace insula {
namespace {

TEST(FacingSearch, FollowsWhatASearchOfAllFinds) {
  const TriMesh ball = shapes::sphere(Vec3(0, 0, 5e-3), 4e-3, 2);
  // Bumps: many vertices are nearest to an edge or a corner.
  const TriMesh ground = shapes::box(Vec3(-0.01, -0.01, -4e-3), Vec3(0.01, 0.01, 0), 12);
  CollisionMesh a, b;
  a.build(ball.vertices, ball.triangles);
  b.build(ground.vertices, ground.triangles);
  std::vector<KnownNearest> known(ball.vertices.size());
  std::vector<Vec3> now = ball.vertices, under = ground.vertices;
  FacingSearch::Seen seen;
  seen.reserve(3 * std::size_t(b.triangle_count()) + 1);
  constexpr double reach = 6e-3, sure = 5e-3, margin = 2e-4;
  int followed = 0, searched = 0, none = 0, changed = 0;
  for (int step = 0; step < 400; ++step) {
    double farthest[2] = {0, 0};
    for (std::size_t v = 0; v < now.size(); ++v) {
      const Vec3 x = ball.vertices[v] + Vec3(3e-3 * std::sin(0.002 * step), 1e-3 * std::sin(0.003 * step),
                                             1.5e-3 * std::sin(0.004 * step));
      farthest[0] = std::max(farthest[0], (x - now[v]).norm());
      now[v] = x;
    }
    for (std::size_t v = 0; v < under.size(); ++v) {
      const Vec3& rest = ground.vertices[v];
      const Vec3 x =
          rest + 2e-4 * Vec3(0, std::sin(600 * rest.x() + 0.01 * step), std::sin(900 * rest.y() - 0.006 * step));
      farthest[1] = std::max(farthest[1], (x - under[v]).norm());
      under[v] = x;
    }
    a.update(now, {});
    b.update(under, {});
    for (std::size_t v = 0; v < now.size(); ++v) {
      KnownNearest& k = known[v];
      const int was = k.triangle;
      k.lessen(farthest[0] + farthest[1], 1);
      FacingSearch search, all;
      search.begin(a, int(v), b, reach, margin);
      const bool settled = search.follow(k, sure, seen);
      if (was >= 0) (settled ? followed : searched) += 1;
      if (!settled) {
        seen.clear();
        for (int t = 0; t < b.triangle_count(); ++t) search.look(t, seen);
        search.settle(k, seen);
      }
      seen.clear();
      all.begin(a, int(v), b, reach, 0);
      for (int t = 0; t < b.triangle_count(); ++t) all.look(t, seen);
      ASSERT_EQ(search.nearest(), all.nearest()) << step << " " << v;
      ASSERT_EQ(k.triangle, all.nearest());
      none += all.nearest() < 0;
      changed += step > 0 && was != k.triangle;
      if (all.nearest() < 0) continue;
      ASSERT_TRUE(search.bary() == all.bary() && search.point() == all.point()) << step << " " << v;
      ASSERT_LE(search.clear(), all.clear() + 1e-15) << "something is nearer than it says";
    }
  }
  EXPECT_GT(followed, 2 * searched) << "or nothing is spared";
  EXPECT_GT(none, 1000);
  EXPECT_GT(changed, 50);
}

}  // namespace
}  // namespace insula
