// SPDX-License-Identifier: GPL-3.0-or-later
// What blood reaches in a straight tube that blades hold flat along a line, against the closed form of that tube.
#include "plugins/clipping_rules/sac_remnant.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

namespace insula {
namespace {

constexpr double radius = 2e-3, height = 8e-3, below = 1e-3, width = 1.3e-3;
constexpr double pi = std::numbers::pi;

/// A tube about +z, from `below` the neck's plane to `height` above it. The lowest ring belongs to the parent.
struct Tube {
  WallModel wall;
  SacRemnant remnant;
  double dz;
  Tube(int around, int rows) : dz((height + below) / rows) {
    wall.regions = {"parent", "neck", "sac"};
    wall.neck_diameter = 2 * radius;
    wall.has_neck = true;
    for (int k = 0; k <= rows; ++k)
      for (int i = 0; i < around; ++i) {
        const double turn = 2 * pi * (i + 0.5) / around, z = -below + (k + 0.5) * dz;  // no ring at z = 0
        wall.wall.vertices.push_back({radius * std::cos(turn), radius * std::sin(turn), z});
        wall.vertex_region.push_back(k == 0 ? 0 : z < 0.4e-3 ? 1 : 2);
      }
    for (int k = 0; k < rows; ++k)
      for (int i = 0; i < around; ++i) {
        const int a = k * around + i, b = k * around + (i + 1) % around;
        wall.wall.triangles.push_back({a, b, a + around});
        wall.wall.triangles.push_back({b, b + around, a + around});
      }
    EXPECT_TRUE(remnant.attach(wall));
  }
  /// Rings of vertices above z = low and below z = high.
  int rings_between(double low, double high) const {
    int count = 0;
    for (double z = -below + 0.5 * dz; z < high - 1e-12; z += dz) count += z > low + 1e-12;
    return count;
  }
  int rings_above() const { return rings_between(0, height + dz); }
  /// Blades along y whose middle crosses the axis at z0 and rises by `slope`, from y0 to infinity.
  SacRemnant::Open clip(double z0, double slope, double tolerance, double y0 = -1) const {
    std::vector<char> held, cut;
    std::vector<double> heights, off;
    for (const SacRemnant::Vertex& v : remnant.vertices()) {
      const Vec3& x = wall.wall.vertices[std::size_t(v.node)];
      off.push_back((x.z() - z0 - slope * x.y()) / std::sqrt(1 + slope * slope));
      held.push_back(std::abs(off.back()) <= 0.5 * width && x.y() >= y0);
      heights.push_back(v.height);
    }
    for (const auto& [a, b] : remnant.edges())
      cut.push_back(y0 < -radius && !held[std::size_t(a)] && !held[std::size_t(b)] &&
                    (off[std::size_t(a)] > 0) != (off[std::size_t(b)] > 0));
    return remnant.measure(held, cut, heights, tolerance);
  }
};

/// Height of the blades' lower edge at y.
double edge(double z0, double slope, double y) { return z0 + slope * y - 0.5 * width * std::sqrt(1 + slope * slope); }

TEST(SacRemnant, LevelBladesLeaveTheTubeBelowTheirLowerEdge) {
  double error[2];
  for (int fine = 0; fine < 2; ++fine) {
    const Tube tube(fine ? 480 : 240, fine ? 720 : 360);
    const SacRemnant::Open open = tube.clip(3e-3, 0, 0.5e-3);
    EXPECT_EQ(open.neck, 1);
    // Counted on the rings of the grid: each stands for two half-cells, and the uppermost for one.
    const double rings = tube.rings_between(0, edge(3e-3, 0, 0)), above = tube.rings_above();
    EXPECT_NEAR(open.sac, rings / (above - 0.5), 1e-9);
    error[fine] = std::abs(open.sac - edge(3e-3, 0, 0) / height);
  }
  EXPECT_LT(error[1], 0.6 * error[0]) << "first order in the height of a cell";
  EXPECT_LT(error[1], 2e-3);
}

TEST(SacRemnant, ObliqueBladesLeaveAWedge) {
  const Tube tube(480, 720);
  for (const double slope : {0.2, 0.4}) {
    const double z0 = 1.3e-3, tolerance = 0.7e-3;
    const SacRemnant::Open open = tube.clip(z0, slope, tolerance);
    // Sectors whose highest column reaches above the tolerance.
    int expected = 0;
    for (int s = 0; s < SacRemnant::sectors; ++s) {
      double highest = -1;
      for (int i = 0; i < 480; ++i) {
        const Vec3 x(std::cos(2 * pi * (i + 0.5) / 480), std::sin(2 * pi * (i + 0.5) / 480), 0);
        const Vec3 u = Vec3::UnitZ().unitOrthogonal(), v = Vec3::UnitZ().cross(u);
        const double turn = std::atan2(x.dot(v), x.dot(u)) / (2 * pi) + 0.5;
        if (int(turn * SacRemnant::sectors) != s) continue;
        const double rows = std::ceil((edge(z0, slope, radius * x.y()) + below) / tube.dz - 0.5 - 1e-9) - 1;
        highest = std::max(highest, (rows + 0.5) * tube.dz - below);
      }
      expected += highest > tolerance + 1e-12;
    }
    EXPECT_NEAR(open.neck, double(expected) / SacRemnant::sectors, 1e-12) << slope;
    const double share = 0.5 + std::asin((edge(z0, slope, 0) - tolerance) / (slope * radius)) / pi;
    EXPECT_NEAR(open.neck, share, 2.0 / SacRemnant::sectors) << slope;
    EXPECT_NEAR(open.sac, edge(z0, slope, 0) / height, 1e-2) << "the wedge has the mean height of its edge";
  }
}

TEST(SacRemnant, BladesThatEndWithinTheTubeCloseNothing) {
  const Tube tube(240, 360);
  const SacRemnant::Open open = tube.clip(1e-3, 0, 0.5e-3, -0.5 * radius);
  EXPECT_EQ(open.neck, 1);
  EXPECT_GT(open.sac, 0.85) << "all but the wall between the blades";
}

TEST(SacRemnant, BladesOnTheNeckLeaveNothing) {
  const Tube tube(240, 360);
  const SacRemnant::Open open = tube.clip(0.2e-3, 0, 0.5e-3);
  EXPECT_EQ(open.neck, 0);
  EXPECT_EQ(open.sac, 0);
}

TEST(SacRemnant, NothingPassesBetweenTheRingsOfACoarseWall) {
  const Tube tube(12, 5);  // rings 1.8 mm apart, blades 1.3 mm wide between two of them
  ASSERT_GT(tube.dz, width);
  const double z0 = 2.6e-3;
  const SacRemnant::Open open = tube.clip(z0, 0, 0.5e-3);
  EXPECT_NEAR(open.sac, tube.rings_between(0, z0) / (tube.rings_above() - 0.5), 1e-9);
}

TEST(SacRemnant, WithoutANeckThereIsNothingToMeasure) {
  WallModel wall;
  SacRemnant remnant;
  EXPECT_FALSE(remnant.attach(wall));
}

}  // namespace
}  // namespace insula
