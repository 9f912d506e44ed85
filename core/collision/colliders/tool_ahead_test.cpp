// SPDX-License-Identifier: GPL-3.0-or-later
// Contacts taken where a tool is expected at the end of the step: closed forms at the edge of a box.
#include <gtest/gtest.h>

#include "core/collision/colliders/tool_collider.h"
#include "core/collision/shapes/shapes_for_test.h"

namespace insula {
namespace {

using shapes::Random;

constexpr double radius = 1e-3;

/// The corner of the quadrant x, z < 0 along y, every vertex with the free displacement `displacement`.
struct Edge {
  TriMesh shape = shapes::box(Vec3(-0.02, -0.02, -0.02), Vec3(0, 0.02, 0), 16);
  std::vector<Vec3> free;
  CollisionMesh mesh;
  explicit Edge(const Vec3& swept = Vec3::Zero()) : free(shape.vertices.size(), swept) {
    mesh.build(shape.vertices, shape.triangles);
    mesh.update(shape.vertices, free);
  }
};

std::vector<Proximity> detect(const Edge& edge, const Vec3& start, const Vec3& free, const Pose& expected,
                              ToolContactSettings settings = {}) {
  ToolCollider c({{"ball", {Vec3::Zero()}, radius}}, edge.mesh.triangle_count());
  std::vector<Proximity> out;
  c.detect(edge.mesh, {start, Quat::Identity()}, {start, Quat::Identity()}, settings,
           out);  // now it knows that the ball is before the surface
  out.clear();
  settings.expected = &expected;
  c.detect(edge.mesh, {start, Quat::Identity()}, {free, Quat::Identity()}, settings, out);
  return out;
}

TEST(ToolAhead, ABallThatGoesOverAnEdgeHasTheGapAndTheNormalOfItsEnd) {
  Random r(3);
  for (int k = 0; k < 200; ++k) {
    const Vec3 surface_way = r.in_box(1e-3);
    const Edge edge(surface_way);
    const Vec3 start(-r.between(0.1e-3, 0.5e-3), r.between(-3e-3, 3e-3), radius);
    const Vec3 beside(r.between(0.3e-3, 1.4e-3), start.y(), r.between(-1.5e-3, 1.2e-3));  // from the edge as it will be
    const Pose expected{surface_way + beside, Quat::Identity()};
    const Vec3 place(0, beside.y(), std::min(0.0, beside.z())), off = beside - place;
    const auto found = detect(edge, start, expected.p - Vec3(0.3e-3, 0, 0), expected);
    ASSERT_FALSE(found.empty());
    double least = 1;
    for (const Proximity& x : found) {
      EXPECT_EQ(x.time, 1) << "none of the start is left";
      least = std::min(least, x.gap);
      // Both of the contact's places go as expected: the row ends at the gap.
      const Vec3 swept = (expected.p - start) - surface_way;
      EXPECT_NEAR(x.start_gap + x.normal.dot(swept), x.gap, 1e-15);
      if (x.gap > least) continue;
      EXPECT_NEAR((x.normal - off.normalized()).norm(), 0, 1e-9);
    }
    EXPECT_NEAR(least, off.norm() - radius, 1e-12);
  }
}

TEST(ToolAhead, WhatRestsHasTheContactsOfTheStart) {
  const Edge edge;
  const Vec3 at(-2.3e-3, 1.1e-3, radius);
  const auto ahead = detect(edge, at, at, {at, Quat::Identity()});
  ToolCollider c({{"ball", {Vec3::Zero()}, radius}}, edge.mesh.triangle_count());
  std::vector<Proximity> start;
  c.detect(edge.mesh, {at, Quat::Identity()}, {at, Quat::Identity()}, {}, start);
  ASSERT_EQ(ahead.size(), start.size());
  for (std::size_t i = 0; i < start.size(); ++i) {
    EXPECT_EQ((ahead[i].normal - start[i].normal).norm(), 0);
    EXPECT_EQ(ahead[i].triangle, start[i].triangle);
    EXPECT_NEAR(ahead[i].start_gap, start[i].start_gap, 1e-15);
  }
}

TEST(ToolAhead, AnOverlapAtTheEndIsUndoneByNoMoreThanAllowed) {
  const Edge edge;
  ToolContactSettings settings;
  settings.max_correction = 0.1e-3;
  const Vec3 start(-5e-3, 0, radius), swept(1e-3, 0, -0.4e-3);
  for (const Proximity& x : detect(edge, start, start + swept, {start + swept, Quat::Identity()}, settings)) {
    EXPECT_NEAR(x.gap, -0.4e-3, 1e-12);
    EXPECT_NEAR(x.start_gap + x.normal.dot(swept), -0.1e-3, 1e-12);
  }
}

TEST(ToolAhead, BehindAWallOrFarFromTheSurfaceTheContactsOfTheStartStay) {
  const Edge edge;
  const Vec3 start(-5e-3, 0, 1.15e-3);
  ToolContactSettings wall;
  wall.offset = 0.15e-3;
  struct Case {
    Vec3 end;
    ToolContactSettings settings;
  };
  for (const Case& c : {Case{Vec3(-5e-3, 0, -0.2e-3), wall}, Case{Vec3(-5e-3, 0, 4e-3), {}}}) {
    const auto found = detect(edge, start, start, {c.end, Quat::Identity()}, c.settings);
    ASSERT_FALSE(found.empty());
    for (const Proximity& x : found) {
      EXPECT_NEAR(x.gap, 1.15e-3 - radius - c.settings.offset, 1e-12);
    }
  }
}

}  // namespace
}  // namespace insula
