// SPDX-License-Identifier: GPL-3.0-or-later
// Curved contact against spheres, cylinders and sharp edges: the gap is that of the smooth body, and its gradient is
// the normal.
#include "core/collision/colliders/curved_contact.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <random>

#include "core/collision/colliders/tool_collider.h"
#include "core/collision/shapes/shapes_for_test.h"

namespace insula {
namespace {

constexpr double radius_m = 1.5e-3, ball_m = 0.5e-3;

using shapes::Still;

TriMesh tube(int sides, double stagger) { return shapes::tube(radius_m, sides, 11, 1e-3, stagger); }

ToolCollider ball() { return {{ConvexPiece{"", {Vec3::Zero()}, ball_m}}, 4096}; }

ToolContactSettings curved_settings() {
  ToolContactSettings s;
  s.curved = true;
  return s;
}

/// The contact of the smallest gap.
Proximity nearest_contact(ToolCollider& tool, const CollisionMesh& mesh, const Pose& pose,
                          const ToolContactSettings& settings) {
  std::vector<Proximity> found;
  tool.detect(mesh, pose, pose, settings, found);
  Proximity best;
  best.gap = 1e300;
  for (const Proximity& x : found)
    if (x.gap < best.gap) best = x;
  return best;
}

Pose at(const Vec3& p) {
  Pose pose;
  pose.p = p;
  return pose;
}

TEST(CurvedContact, ABallAroundATubeHasTheGapOfTheCylinder) {
  for (const int sides : {12, 16, 24}) {
    const Still body(tube(sides, 0));
    ToolCollider tool = ball();
    double flat_error = 0, curved_error = 0, turned = 0;
    for (double a = 0; a < 2; a += 0.013) {
      const Vec3 out(std::cos(a), std::sin(a), 0);
      const Pose pose = at((radius_m + ball_m + 1e-5) * out + Vec3(0, 0, 0.37e-3 + 1e-4 * a));
      const Proximity x = nearest_contact(tool, body.mesh, pose, curved_settings());
      curved_error = std::max(curved_error, std::abs(x.gap - 1e-5));
      turned = std::max(turned, x.normal.cross(out).norm());
      flat_error = std::max(flat_error, std::abs(nearest_contact(tool, body.mesh, pose, {}).gap - 1e-5));
    }
    const double side_m = 2 * radius_m * std::sin(std::numbers::pi / sides);
    // The height of a facet, and what the curve leaves of it: the fourth order of its side.
    EXPECT_NEAR(flat_error, side_m * side_m / (8 * radius_m), 0.1 * flat_error);
    EXPECT_LT(curved_error, 0.05 * std::pow(side_m, 4) / std::pow(radius_m, 3)) << sides;
    EXPECT_LT(curved_error, 0.02 * flat_error) << sides;
    EXPECT_LT(turned, 0.01) << sides;
  }
}

TEST(CurvedContact, TheNormalIsTheGradientOfTheGap) {
  const Still body(tube(12, 0.3));
  ToolCollider tool = ball();
  std::mt19937_64 random(3);
  std::uniform_real_distribution<double> unit(-1, 1);
  constexpr double h = 1e-8;
  for (int n = 0; n < 300; ++n) {
    const double a = 3 * unit(random);
    const Vec3 p =
        (radius_m + ball_m + 1e-4 * unit(random)) * Vec3(std::cos(a), std::sin(a), 0) + Vec3(0, 0, 3e-3 * unit(random));
    const Proximity x = nearest_contact(tool, body.mesh, at(p), curved_settings());
    for (int k = 0; k < 3; ++k) {
      const double more = nearest_contact(tool, body.mesh, at(p + h * Vec3::Unit(k)), curved_settings()).gap,
                   less = nearest_contact(tool, body.mesh, at(p - h * Vec3::Unit(k)), curved_settings()).gap;
      EXPECT_NEAR((more - less) / (2 * h), x.normal[k], 1e-6) << n;
    }
  }
}

TEST(CurvedContact, ARodAcrossATubeHasTheGapOfTheCylinder) {
  const Still body(tube(16, 0.2));
  ToolCollider tool({ConvexPiece{"", {Vec3(-4e-3, 0, 0), Vec3(4e-3, 0, 0)}, ball_m}}, 4096);
  for (double a = 0; a < 1; a += 0.017) {
    Pose pose;
    pose.q = Eigen::AngleAxisd(a, Vec3::UnitZ()) * Eigen::AngleAxisd(0.4, Vec3::UnitY());
    pose.p = pose.q * Vec3(1.1e-3, 0, 0) + (radius_m + ball_m) * Vec3(-std::sin(a), std::cos(a), 0);
    const Proximity x = nearest_contact(tool, body.mesh, pose, curved_settings());
    EXPECT_NEAR(x.gap, 0, 4e-7) << a;
  }
}

TEST(CurvedContact, ABallOnASphereHasTheGapOfTheSphere) {
  const Still body(shapes::sphere(Vec3::Zero(), radius_m, 3));
  ToolCollider tool = ball();
  std::mt19937_64 random(5);
  std::normal_distribution<double> normal;
  double flat_error = 0, curved_error = 0;
  for (int n = 0; n < 500; ++n) {
    const Vec3 out = Vec3(normal(random), normal(random), normal(random)).normalized();
    const Pose pose = at((radius_m + ball_m) * out);
    const Proximity x = nearest_contact(tool, body.mesh, pose, curved_settings());
    curved_error = std::max(curved_error, std::abs(x.gap));
    flat_error = std::max(flat_error, std::abs(nearest_contact(tool, body.mesh, pose, {}).gap));
    EXPECT_LT(x.normal.cross(out).norm(), 0.02);
  }
  EXPECT_GT(flat_error, 10e-6);
  EXPECT_LT(curved_error, 0.2 * flat_error);
}

TEST(CurvedContact, ASharpEdgeStaysSharp) {
  const Still body(shapes::box(Vec3::Constant(-2e-3), Vec3::Constant(2e-3), 4));
  ToolCollider tool = ball();
  for (double y = -1.9e-3; y < 2e-3; y += 1.3e-4) {
    const Proximity x = nearest_contact(tool, body.mesh, at(Vec3(2.6e-3, y, 0.4e-3)), curved_settings());
    EXPECT_NEAR(x.gap, 1e-4, 1e-12);
    EXPECT_NEAR(x.normal[0], 1, 1e-12);
  }
}

}  // namespace
}  // namespace insula
