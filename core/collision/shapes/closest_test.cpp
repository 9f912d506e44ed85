// SPDX-License-Identifier: GPL-3.0-or-later
// Closest points against dense sampling and against what must hold at a minimum.
#include "core/collision/shapes/closest.h"

#include <gtest/gtest.h>

#include "core/collision/shapes/gjk.h"
#include "core/collision/shapes/shapes_for_test.h"

namespace insula {
namespace {

using shapes::Random;

double sampled_point_triangle(const Vec3& p, const Vec3& a, const Vec3& b, const Vec3& c, int n) {
  double best = 1e300;
  for (int i = 0; i <= n; ++i)
    for (int j = 0; j <= n - i; ++j) best = std::min(best, (p - (a * i + b * j + c * (n - i - j)) / n).norm());
  return best;
}

TEST(Closest, PointTriangleAgreesWithSampling) {
  Random r(1);
  for (int k = 0; k < 300; ++k) {
    const Vec3 a = r.in_box(1), b = r.in_box(1), c = r.in_box(1), p = r.in_box(2);
    const ClosestPair q = point_triangle(p, a, b, c);
    const double sampled = sampled_point_triangle(p, a, b, c, 100);
    EXPECT_LE(std::sqrt(q.distance2), sampled + 1e-12);
    EXPECT_GE(std::sqrt(q.distance2), sampled - 0.05);
    EXPECT_GE(q.bary.minCoeff(), 0);
    EXPECT_NEAR(q.bary.sum(), 1, 1e-12);
    // Optimality: no corner lies in the direction of p as seen from c.
    for (const Vec3& v : {a, b, c}) EXPECT_LE((p - q.c).dot(v - q.c), 1e-9);
  }
}

TEST(Closest, DegenerateTriangles) {
  Random r(2);
  for (int k = 0; k < 200; ++k) {
    const Vec3 a = r.in_box(1), d = r.direction(), p = r.in_box(2);
    const Vec3 b = a + d, c = a + r.between(-2, 2) * d;  // collinear
    ClosestPair q = point_triangle(p, a, b, c);
    EXPECT_NEAR(std::sqrt(q.distance2), sampled_point_triangle(p, a, b, c, 400), 1e-2);
    EXPECT_NEAR(q.bary.sum(), 1, 1e-12);
    EXPECT_GE(q.bary.minCoeff(), 0);
    q = point_triangle(p, a, a, a);  // a point
    EXPECT_NEAR(std::sqrt(q.distance2), (p - a).norm(), 1e-12);
    q = segment_triangle(p, p, a, a, a);
    EXPECT_NEAR(std::sqrt(q.distance2), (p - a).norm(), 1e-12);
    q = segment_triangle(p, r.in_box(2), a, b, c);
    EXPECT_TRUE(std::isfinite(q.distance2));
  }
}

TEST(Closest, SegmentTriangleAgreesWithSamplingAndMeets) {
  Random r(3);
  int met = 0;
  for (int k = 0; k < 2000; ++k) {
    const Vec3 a = r.in_box(1), b = r.in_box(1), c = r.in_box(1), p = r.in_box(1.5), q = r.in_box(1.5);
    const ClosestPair x = segment_triangle(p, q, a, b, c);
    double sampled = 1e300;
    for (int i = 0; i <= 200; ++i)
      sampled = std::min(sampled, point_triangle(p + (q - p) * i / 200, a, b, c).distance2);
    EXPECT_LE(x.distance2, sampled + 1e-12);
    EXPECT_GE(std::sqrt(x.distance2), std::sqrt(sampled) - 0.02);
    if (x.distance2 == 0) {
      ++met;
      const Vec3 n = (b - a).cross(c - a).normalized();
      EXPECT_LE(n.dot(p - a) * n.dot(q - a), 1e-12);
      EXPECT_NEAR(n.dot(x.c - a), 0, 1e-12);
    } else {
      EXPECT_NEAR((x.p - x.c).squaredNorm(), x.distance2, 1e-12);
    }
    EXPECT_NEAR((x.bary[0] * a + x.bary[1] * b + x.bary[2] * c - x.c).norm(), 0, 1e-12);
  }
  EXPECT_GT(met, 50);
}

TEST(Closest, ParallelSegments) {
  double s, t;
  closest_segments({0, 0, 0}, {1, 0, 0}, {0.25, 1, 0}, {3, 1, 0}, s, t);
  EXPECT_NEAR(((Vec3(s, 0, 0)) - Vec3(0.25 + 2.75 * t, 1, 0)).norm(), 1, 1e-12);
  closest_segments({0, 0, 0}, {1, 0, 0}, {2, 0, 0}, {3, 0, 0}, s, t);
  EXPECT_DOUBLE_EQ(s, 1);
  EXPECT_DOUBLE_EQ(t, 0);
}

TEST(Hulls, AgreeWithPointAndSegmentRoutines) {
  Random r(4);
  for (int k = 0; k < 2000; ++k) {
    const std::array<Vec3, 3> tri{r.in_box(0.01), r.in_box(0.01), r.in_box(0.01)};
    const std::array<Vec3, 2> seg{r.in_box(0.03), r.in_box(0.03)};
    const ClosestPair s = segment_triangle(seg[0], seg[1], tri[0], tri[1], tri[2]);
    EXPECT_NEAR(hull_distance(seg, tri).distance, std::sqrt(s.distance2), 1e-9);
    const ClosestPair p = point_triangle(seg[0], tri[0], tri[1], tri[2]);
    EXPECT_NEAR(hull_distance(std::span(seg).first(1), tri).distance, std::sqrt(p.distance2), 1e-10);
  }
}

TEST(Hulls, BoxAgainstTriangleSatisfiesTheOptimalityCondition) {
  Random r(5);
  int apart = 0, met = 0;
  for (int k = 0; k < 2000; ++k) {
    std::vector<Vec3> box;
    const Mat3 turn = from_rotation_vector(r.in_box(2)).toRotationMatrix();
    const Vec3 at = r.in_box(0.015), half(0.004, 0.002, 0.0003);
    for (int i = 0; i < 8; ++i)
      box.push_back(at +
                    turn * Vec3(i & 1 ? half[0] : -half[0], i & 2 ? half[1] : -half[1], i & 4 ? half[2] : -half[2]));
    const std::array<Vec3, 3> tri{r.in_box(0.01), r.in_box(0.01), r.in_box(0.01)};
    const HullDistance d = hull_distance(box, tri);
    if (d.distance > 0) {
      // A separating plane through both points is a proof of minimality.
      ++apart;
      const Vec3 n = (d.a - d.b) / d.distance;
      for (const Vec3& v : box) EXPECT_GE(n.dot(v - d.a), -1e-9);
      for (const Vec3& v : tri) EXPECT_LE(n.dot(v - d.b), 1e-9);
      double sum = 0;
      for (int i = 0; i < d.count; ++i) sum += d.weight[i];
      EXPECT_NEAR(sum, 1, 1e-12);
    } else {
      // Some edge of one goes through the other, or the box holds the triangle.
      ++met;
      double least = 1e300;
      for (int i = 0; i <= 60; ++i)
        for (int j = 0; j <= 60 - i; ++j) {
          const Vec3 x = turn.transpose() * ((tri[0] * i + tri[1] * j + tri[2] * (60 - i - j)) / 60 - at);
          least = std::min(least, (x.cwiseAbs() - half).cwiseMax(0.0).norm());
        }
      EXPECT_LT(least, 4e-4);
    }
  }
  EXPECT_GT(apart, 500);
  EXPECT_GT(met, 50);
}

TEST(Hulls, BeyondALimitABoundIsEnough) {
  Random r(6);
  int beyond = 0, within = 0;
  for (int k = 0; k < 3000; ++k) {
    std::array<Vec3, 8> hull;
    const Vec3 at = r.in_box(0.012);
    for (Vec3& p : hull) p = at + r.in_box(0.004);
    const std::array<Vec3, 3> tri{r.in_box(0.01), r.in_box(0.01), r.in_box(0.01)};
    const double exact = hull_distance(hull, tri).distance, limit = r.between(0, 0.01);
    const double bound = hull_distance(hull, tri, limit).distance;
    if (exact > limit * (1 + 1e-9)) {
      ++beyond;
      EXPECT_GT(bound, limit);
      EXPECT_LE(bound, exact * (1 + 1e-9));
    } else if (exact < limit) {
      ++within;
      EXPECT_EQ(bound, exact);
    }
  }
  EXPECT_GT(beyond, 500);
  EXPECT_GT(within, 500);
}

TEST(Hulls, TouchingAndFlatShapes) {
  const std::array<Vec3, 3> tri{Vec3(0, 0, 0), Vec3(1, 0, 0), Vec3(0, 1, 0)};
  const std::array<Vec3, 4> flat{Vec3(0, 0, 0.5), Vec3(1, 0, 0.5), Vec3(1, 1, 0.5), Vec3(0, 1, 0.5)};
  EXPECT_NEAR(hull_distance(flat, tri).distance, 0.5, 1e-12);
  const std::array<Vec3, 4> same{Vec3(0, 0, 0), Vec3(1, 0, 0), Vec3(1, 1, 0), Vec3(0, 1, 0)};
  EXPECT_EQ(hull_distance(same, tri).distance, 0);
  const std::array<Vec3, 1> corner{Vec3(0, 0, 0)};
  EXPECT_EQ(hull_distance(corner, tri).distance, 0);
  for (double gap : {1e-3, 1e-5, 1e-7, 1e-9}) {
    std::array<Vec3, 4> near = same;
    for (Vec3& v : near) v += Vec3(0.1, 0.1, gap);
    EXPECT_NEAR(hull_distance(near, tri).distance, gap, 1e-6 * gap + 1e-12);
  }
}

}  // namespace
}  // namespace insula
