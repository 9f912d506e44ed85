// SPDX-License-Identifier: GPL-3.0-or-later
// Colliders keep what they know from step to step. That must never show: through long smooth motions they find what a
// collider finds that has to look everywhere in every step.
//
// The reference sees the same shapes 1 m off to one side and back, by turns: everything has moved far, so nothing it
// knows of distances is good, while what it remembers of contacts stays. Places are multiples of 2^-40 m, so that
// shifting loses no bit.
#include <gtest/gtest.h>

#include "core/collision/colliders/self_collider.h"
#include "core/collision/colliders/tissue_collider.h"
#include "core/collision/shapes/shapes_for_test.h"

namespace insula {
namespace {

/// A smooth motion of random waves: what a place moves by at time t.
struct Waves {
  struct Wave {
    Vec3 along, across;
    double rate, phase;
  };
  std::vector<Wave> waves;
  Waves(unsigned seed, double size, double longest) {
    shapes::Random r(seed);
    for (int i = 0; i < 6; ++i) {
      const Vec3 along = r.direction();
      const Vec3 across = r.direction() * (2 * M_PI / r.between(0.5 * longest, longest));
      waves.push_back({size * along, across, r.between(0.01, 0.05), r.between(0, 6)});
    }
  }
  Vec3 at(const Vec3& x, double t) const {
    Vec3 u = Vec3::Zero();
    for (const Wave& w : waves) u += std::sin(w.across.dot(x) + w.rate * t + w.phase) * w.along;
    return u;
  }
};

Vec3 whole(const Vec3& x) {
  constexpr double grid = 1.0 / (1ll << 40);
  return ((x / grid).array().round() * grid).matrix();
}

/// A deforming mesh, and its twin 1 m off.
struct Twin {
  TriMesh rest;
  std::vector<Vec3> now, off, free;
  CollisionMesh mesh, other;
  explicit Twin(TriMesh m) : rest(std::move(m)), now(rest.vertices), off(now), free(now.size(), Vec3::Zero()) {
    mesh.build(rest.vertices, rest.triangles);
    other.build(rest.vertices, rest.triangles);
  }
  template <class Place>
  void move(const Place& place, const Vec3& shift) {
    for (std::size_t i = 0; i < now.size(); ++i) {
      const Vec3 x = whole(place(rest.vertices[i]));
      free[i] = whole(x - now[i]);
      now[i] = x;
      off[i] = x + shift;
    }
    mesh.update(now, free);
    other.update(off, free);
  }
};

void expect_same(const std::vector<Proximity>& a, const std::vector<Proximity>& b, const Vec3& shift, int step) {
  ASSERT_EQ(a.size(), b.size()) << step;
  for (std::size_t i = 0; i < a.size(); ++i) {
    ASSERT_EQ(a[i].vertex, b[i].vertex) << step;
    ASSERT_EQ(a[i].side, b[i].side) << step;
    // On an edge between two triangles either may be named; the place is one.
    ASSERT_NEAR(a[i].gap, b[i].gap, 1e-12) << step;
    ASSERT_NEAR(a[i].start_gap, b[i].start_gap, 1e-12) << step;
    ASSERT_LT((a[i].point + shift - b[i].point).norm(), 1e-9) << step;
    if (std::abs(a[i].gap) > 1e-6) {
      ASSERT_LT((a[i].normal - b[i].normal).norm(), 1e-6) << step;
    }
  }
}

void expect_identical(const std::vector<Proximity>& a, const std::vector<Proximity>& b, int step) {
  ASSERT_EQ(a.size(), b.size()) << step;
  for (std::size_t i = 0; i < a.size(); ++i) {
    ASSERT_EQ(a[i].vertex, b[i].vertex) << step;
    ASSERT_EQ(a[i].side, b[i].side) << step;
    ASSERT_EQ(a[i].triangle, b[i].triangle) << step;
    ASSERT_EQ(a[i].gap, b[i].gap) << step;
    ASSERT_EQ(a[i].start_gap, b[i].start_gap) << step;
    ASSERT_TRUE(a[i].normal == b[i].normal && a[i].point == b[i].point && a[i].bary == b[i].bary) << step;
  }
}

// A box that is pressed flat, lets go and is pressed again, waving: for any number of workers, with lists and without.
TEST(ColliderCache, OfAWallAgainstItselfNeverShows) {
  constexpr double thickness = 0.3e-3;
  for (const unsigned seed : {1u, 2u}) {
    Twin twin(shapes::box(Vec3(-5e-3, -5e-3, -1e-3), Vec3(5e-3, 5e-3, 1e-3), 10));
    const auto collider = [&] { return SelfCollider(twin.rest.vertices, twin.rest.triangles, 0.7e-3, thickness); };
    SelfCollider lists = collider(), reference = collider(), two = collider(), three = collider();
    Workers one(1), pair(2), triple(3);
    const Waves waves(seed, 0.08e-3, 10e-3);
    SelfContactSettings settings;
    settings.outer = true;
    int with = 0, without = 0, crossed = 0;
    std::vector<Proximity> a, b, c, d;
    for (int step = 0; step < 400; ++step) {
      // Height from 2.2 to -0.1 mm, about 8 micrometres a step, with rests.
      const double phase = 0.016 * (step + 20 * std::sin(0.05 * step)), h = 1.05e-3 + 1.15e-3 * std::cos(phase);
      const Vec3 shift = step % 2 ? Vec3(1, 0, 0) : Vec3(0, 0, 0);
      twin.move([&](const Vec3& x) -> Vec3 { return Vec3(x.x(), x.y(), x.z() * h / 2e-3) + waves.at(x, step); }, shift);
      for (auto* found : {&a, &b, &c, &d}) found->clear();
      lists.detect(twin.mesh, settings, a, one);
      reference.detect(twin.other, settings, b, one);
      two.detect(twin.mesh, settings, c, pair);
      three.detect(twin.mesh, settings, d, triple);
      ASSERT_NO_FATAL_FAILURE(expect_same(a, b, shift, step)) << "seed " << seed;
      ASSERT_NO_FATAL_FAILURE(expect_identical(a, c, step));
      ASSERT_NO_FATAL_FAILURE(expect_identical(a, d, step));
      (a.empty() ? without : with) += 1;
      for (const Proximity& x : a) crossed += x.gap < -thickness;
    }
    EXPECT_GT(with, 100);
    EXPECT_GT(without, 20);
    EXPECT_GT(crossed, 100);
  }
}

// A ball that rolls over a waving slab and dips into it.
TEST(ColliderCache, OfTwoTissuesNeverShows) {
  for (const unsigned seed : {1u, 2u, 3u, 4u}) {
    Twin ball(shapes::sphere(Vec3(0, 0, 4e-3), 4e-3, 3)),
        slab(shapes::box(Vec3(-0.012, -0.012, -6e-3), Vec3(0.012, 0.012, 0), 12));
    const auto samples = sample_vertices(ball.rest.vertices, ball.rest.triangles, 0.5e-3);
    TissueCollider cached(samples, ball.rest.vertices, slab.mesh.triangle_count()),
        reference(samples, ball.rest.vertices, slab.mesh.triangle_count());
    const Waves waves(seed, 0.1e-3, 12e-3), path(seed + 10, 1e-3, 1e3);
    int with = 0, without = 0, deep = 0;
    std::vector<Proximity> a, b;
    for (int step = 0; step < 400; ++step) {
      const Vec3 shift = step % 2 ? Vec3(0, 1, 0) : Vec3(0, 0, 0),
                 swept = path.at(Vec3::Zero(), step) + Vec3(0, 0, 1e-3 + 1.7e-3 * std::sin(0.02 * step));
      ball.move([&](const Vec3& x) { return Vec3(x + swept + waves.at(x, step)); }, shift);
      slab.move([&](const Vec3& x) { return Vec3(x + waves.at(x, -step)); }, shift);
      a.clear();
      b.clear();
      cached.detect(ball.mesh, slab.mesh, {}, a);
      reference.detect(ball.other, slab.other, {}, b);
      ASSERT_NO_FATAL_FAILURE(expect_same(a, b, shift, step)) << "seed " << seed;
      (a.empty() ? without : with) += 1;
      for (const Proximity& x : a) deep += x.gap < -0.5e-3;
    }
    EXPECT_GT(with, 100) << seed;
    EXPECT_GT(without, 20) << seed;
    EXPECT_GT(deep, 20) << seed;
  }
}

}  // namespace
}  // namespace insula
