// SPDX-License-Identifier: GPL-3.0-or-later
// Friction of given strength in a plane: against the minimum that a search finds, and against its own law.
#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <cmath>

#include "core/base/random.h"
#include "core/constraint/friction.h"
#include "core/testing/held.h"

namespace insula {
namespace {

using Vec2 = Eigen::Vector2d;
using Mat2 = Eigen::Matrix2d;

Vec2 disc(const Mat2& w, const Vec2& q, double bound) {
  Vec2 out;
  solve_disc(w(0, 0), w(0, 1), w(1, 1), q[0], q[1], bound, out.data());
  return out;
}

/// Symmetric with the eigenvalues 1 and `ratio`, turned by `angle`.
Mat2 matrix(double ratio, double angle) {
  const Mat2 r = Eigen::Rotation2Dd(angle).toRotationMatrix();
  return r * Vec2(1, ratio).asDiagonal() * r.transpose();
}

// The law is that of the least of l W l / 2 + q l over the disc: the inner minimum if it lies inside, else the lowest
// place of the rim, found by a scan and bisection of its slope.
Vec2 search(const Mat2& w, const Vec2& q, double bound) {
  const Vec2 free = -w.fullPivLu().solve(q);
  if (free.norm() <= bound) return free;
  const auto at = [&](double angle) { return Vec2(bound * std::cos(angle), bound * std::sin(angle)); };
  // Of the energy along the rim: zero at the minimum, from below to above.
  const auto slope = [&](double angle) {
    const Vec2 l = at(angle);
    return (w * l + q).dot(Vec2(-l[1], l[0]));
  };
  const auto energy = [&](double angle) { return (0.5 * at(angle).dot(w * at(angle)) + q.dot(at(angle))); };
  constexpr int n = 2000;
  const double step = 2 * M_PI / n;
  int best = 0;
  for (int i = 1; i < n; ++i)
    if (energy(i * step) < energy(best * step)) best = i;
  double low = (best - 1) * step, high = (best + 1) * step;
  for (int i = 0; i < 80; ++i) {
    const double middle = 0.5 * (low + high);
    (slope(middle) < 0 ? low : high) = middle;
  }
  return at(0.5 * (low + high));
}

TEST(Disc, IsTheSolutionThatASearchFinds) {
  Random random(3);
  int stick = 0, slip = 0;
  for (int trial = 0; trial < 4000; ++trial) {
    const Mat2 w =
        matrix(std::pow(10.0, random.uniform(-4, 0)), random.uniform(0, 7)) * std::pow(10.0, random.uniform(-5, 1));
    const Vec2 q(random.uniform(-1, 1), random.uniform(-1, 1));
    const double free = w.fullPivLu().solve(q).norm();
    const double bound = free * random.uniform(0.01, 1.5);
    const Vec2 l = disc(w, q, bound), expected = search(w, q, bound);
    ASSERT_TRUE(test::held("friction of a patch = search", (l - expected).norm(), bound, 1e-7)) << trial;
    const Vec2 delta = w * l + q;
    if (bound > free) {
      ++stick;
      ASSERT_LT(delta.norm(), 1e-11 * q.norm()) << trial;
      ASSERT_LE(l.norm(), bound);
    } else {
      ++slip;
      ASSERT_NEAR(l.norm(), bound, 1e-12 * bound) << trial;
      ASSERT_LT((delta.normalized() + l.normalized()).norm(), 1e-9 * q.norm() / delta.norm())
          << trial << ": slip and force are not opposed";
    }
  }
  EXPECT_GT(stick, 1000);
  EXPECT_GT(slip, 2000);
}

TEST(Disc, KnownAnswers) {
  // One number in place of the matrix: the force is -q / w, or as long as it may be.
  const Mat2 two = 2 * Mat2::Identity();
  EXPECT_LT((disc(two, Vec2(3, -4), 10) - Vec2(-1.5, 2)).norm(), 1e-15);
  EXPECT_LT((disc(two, Vec2(3, -4), 0.5) - Vec2(-0.3, 0.4)).norm(), 1e-15);
  // Along an axis of the matrix the other plays no part.
  const Mat2 w = Vec2(1, 100).asDiagonal();
  EXPECT_LT((disc(w, Vec2(5, 0), 2) - Vec2(-2, 0)).norm(), 1e-15);
  EXPECT_LT((disc(w, Vec2(0, 5), 2) - Vec2(0, -0.05)).norm(), 1e-15);
  // On the rim to the last bit there is no slip.
  EXPECT_LT((two * disc(two, Vec2(3, -4), 2.5) + Vec2(3, -4)).norm(), 1e-14);
}

TEST(Disc, WithoutStrengthOrWithoutAMatrixThereIsNoForce) {
  for (const double bound : {0.0, -1.0, std::nan("")})
    EXPECT_TRUE(disc(Mat2::Identity(), Vec2(1, 2), bound).isZero(0)) << bound;
  EXPECT_TRUE(disc(Mat2::Zero(), Vec2(1, 2), 1).isZero(0));
  EXPECT_TRUE(disc(Mat2::Identity(), Vec2::Zero(), 1).isZero(0));
}

// One direction that hardly yields, or not at all: never longer than it may be, never upwards, and never worse than
// what the other direction alone can do.
TEST(Disc, NearlySingularMatricesKeepTheBoundAndOpposeTheSlip) {
  Random random(5);
  for (const double ratio : {1e-8, 1e-11, 1e-13, 1e-16, 0.0})
    for (int trial = 0; trial < 500; ++trial) {
      const Mat2 w = matrix(ratio, trial % 5 == 0 ? 0 : random.uniform(0, 7));
      const Vec2 q(random.uniform(-1, 1), random.uniform(-1, 1));
      const double bound = std::pow(10.0, random.uniform(-3, 3));
      const Vec2 l = disc(w, q, bound);
      ASSERT_TRUE(l.allFinite());
      ASSERT_LE(l.norm(), bound * (1 + 1e-12));
      const Vec2 delta = w * l + q;
      ASSERT_LE(l.dot(delta), 1e-9 * bound * q.norm()) << "friction that drives";
      const auto energy = [&](const Vec2& x) { return 0.5 * x.dot(w * x) + q.dot(x); };
      ASSERT_LE(energy(l), energy(search(w + 1e-12 * Mat2::Identity(), q, bound)) + 1e-6 * bound * q.norm())
          << ratio << " " << trial;
    }
}

}  // namespace
}  // namespace insula
