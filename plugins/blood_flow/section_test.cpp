// SPDX-License-Identifier: GPL-3.0-or-later
// Cross-sections of a wall.
#include "plugins/blood_flow/section.h"

#include <gtest/gtest.h>

#include <numbers>

#include "core/testing/held.h"
#include "plugins/pressure/shell_for_test.h"

namespace insula {
namespace {

TEST(Section, CutsTheLoopAroundItsPointAndMeasuresIt) {
  const TriMesh m = test::tube(Vec3(0.01, 0.02, 0), 0.002, 0.01, 16, 5);
  VecX q(3 * Eigen::Index(m.vertices.size()));
  for (std::size_t i = 0; i < m.vertices.size(); ++i) q.segment<3>(3 * Eigen::Index(i)) = m.vertices[i];
  const double side = 2 * 0.002 * std::sin(std::numbers::pi / 16),
               area = 0.5 * 16 * 0.002 * 0.002 * std::sin(2 * std::numbers::pi / 16);
  // On a prism every corner lies on a straight line, so the polygon is exact whatever triangles are cut.
  const Section s = cut(m.vertices, m.triangles, Vec3(0.0103, 0.02, 0.0043), Vec3(0, 0, 3));
  EXPECT_TRUE(test::held("area of a section", std::abs(s.wall(q).area - area), area, 1e-12));
  EXPECT_NEAR(s.wall(q).perimeter, 16 * side, 1e-12);
  EXPECT_TRUE(cut(m.vertices, m.triangles, Vec3(0.015, 0.02, 0.0043), Vec3(0, 0, 1)).corners.empty())
      << "a loop beside the point";
  const double t = 3e-4;
  EXPECT_NEAR(s.lumen(q, t).area, area - 16 * side * t / 2 + std::numbers::pi * t * t / 4, 1e-16);
  // Turned and moved it is the same; pressed flat to one thickness nothing is left but its folds.
  const Quat turn = from_rotation_vector(Vec3(0.4, -0.2, 1));
  VecX moved = q;
  for (int i = 0; i < q.size() / 3; ++i) moved.segment<3>(3 * i) = turn * q.segment<3>(3 * i) + Vec3(1, 2, 3);
  EXPECT_NEAR(s.wall(moved).area, area, 1e-10 * area);
  for (int i = 0; i < q.size() / 3; ++i) q[3 * i] = 0.01 + (q[3 * i] > 0.01 ? 1 : -1) * t / 2;
  EXPECT_LT(s.lumen(q, t).area, 0.02 * area);
}

}  // namespace
}  // namespace insula
