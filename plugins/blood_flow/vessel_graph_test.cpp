// SPDX-License-Identifier: GPL-3.0-or-later
// The lumen of a station is that of the cross-section that is narrowed most, whatever the angle of what presses on it.
#include "plugins/blood_flow/vessel_graph.h"

#include <gtest/gtest.h>

#include <numbers>

#include "plugins/pressure/shell_for_test.h"

namespace insula {
namespace {

constexpr double radius = 2e-3, length = 12e-3, thickness = 2e-4;

/// A tube along z from an opening to a dead end, where it is wider.
struct Tube {
  WallModel model;
  VesselGraph graph;
  VecX q;
  Tube() {
    model.wall = test::tube(Vec3::Zero(), radius, length, 48, 120);
    for (Vec3& x : model.wall.vertices)
      if (x.z() > 0.8 * length) x.head<2>() *= 1.2;
    model.regions = {"sac"};
    model.vertex_region.assign(model.wall.vertices.size(), 0);
    model.caps.push_back({"neck", {}});
    WallModel::Centreline line{"sac", "sac", "neck", "dome", {}, {}};
    for (int k = 0; k <= 24; ++k) {
      line.points.emplace_back(0, 0, length * k / 24);
      line.radius.push_back(radius);
    }
    model.centrelines.push_back(line);
    q.resize(3 * Eigen::Index(model.wall.vertices.size()));
    for (std::size_t i = 0; i < model.wall.vertices.size(); ++i)
      q.segment<3>(3 * Eigen::Index(i)) = model.wall.vertices[i];
  }
  /// Presses the wall flat across x within a slab that is tilted about x; `half_width` of the slab, m.
  void press(double tilt, double half_width) {
    const Vec3 n(0, std::sin(tilt), std::cos(tilt)), at(0, 0, 0.5 * length);
    for (Eigen::Index i = 0; i < q.size() / 3; ++i)
      if (std::abs(n.dot(q.segment<3>(3 * i) - at)) < half_width)
        q[3 * i] = std::copysign(std::min(std::abs(q[3 * i]), 0.5 * thickness), q[3 * i]);
  }
  double narrowest() {
    graph.measure(q, thickness, 4e-3, 0.03);
    return graph.stretches.at(0).narrowest;
  }
};

class ObliqueClip : public ::testing::TestWithParam<double> {};

TEST_P(ObliqueClip, ShutsTheVessel) {
  Tube t;
  ASSERT_EQ(t.graph.build(t.model, t.model.wall.triangles, thickness, 5e-4), "");
  EXPECT_NEAR(t.narrowest(), 1, 1e-12);
  t.press(GetParam() * std::numbers::pi / 180, 0.65e-3);
  EXPECT_EQ(t.narrowest(), 0);
}

INSTANTIATE_TEST_SUITE_P(Tilts, ObliqueClip, ::testing::Values(0.0, 9.0, 15.0, -21.0, 28.0));

TEST(VesselGraph, ABladeThatEndsWithinTheVesselLeavesItOpen) {
  Tube t;
  ASSERT_EQ(t.graph.build(t.model, t.model.wall.triangles, thickness, 5e-4), "");
  const VecX rest = t.q;
  t.press(0.2, 0.65e-3);
  // Only where y is below half of the radius.
  for (Eigen::Index i = 0; i < t.q.size() / 3; ++i)
    if (rest[3 * i + 1] > 0.5 * radius) t.q.segment<3>(3 * i) = rest.segment<3>(3 * i);
  // The open segment of a circle beyond the chord at half of the radius, over the circle.
  const double segment = (std::numbers::pi / 3 - std::sqrt(3.0) / 4) / std::numbers::pi;
  EXPECT_GT(t.narrowest(), 0.6 * segment);
  EXPECT_LT(t.narrowest(), 1.2 * segment);
}

}  // namespace
}  // namespace insula
