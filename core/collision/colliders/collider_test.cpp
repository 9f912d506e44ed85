// SPDX-License-Identifier: GPL-3.0-or-later
// Tools and surfaces against surfaces: distances in closed form, looking ahead, selection.
#include <gtest/gtest.h>

#include "core/collision/colliders/contact_selection.h"
#include "core/collision/colliders/tissue_collider.h"
#include "core/collision/colliders/tool_collider.h"
#include "core/collision/shapes/shapes_for_test.h"

namespace insula {
namespace {

using shapes::Random;

using Scene = shapes::Still;

std::vector<ConvexPiece> ball(double radius) { return {{"ball", {Vec3::Zero()}, radius}}; }
std::vector<ConvexPiece> rod(double length, double radius) {
  return {{"rod", {Vec3::Zero(), Vec3(0, 0, length)}, radius}};
}
std::vector<ConvexPiece> blade() {
  ConvexPiece p{"blade", {}, 0};
  for (int i = 0; i < 8; ++i) p.points.push_back({i & 1 ? 2e-4 : -2e-4, i & 2 ? 4e-3 : -4e-3, i & 4 ? 0.03 : 0.0});
  return {p};
}

std::vector<Proximity> detect(const Scene& s, const std::vector<ConvexPiece>& pieces, const Pose& start,
                              const Pose& free, const ToolContactSettings& settings = {}) {
  ToolCollider c(pieces, s.mesh.triangle_count());
  std::vector<Proximity> out;
  c.detect(s.mesh, start, free, settings, out);
  return out;
}

double min_gap(const std::vector<Proximity>& all) {
  double g = 1e300;
  for (const auto& x : all) g = std::min(g, x.gap);
  return g;
}

TEST(ToolCollider, BallOverBoxHasTheExactGapAndNormalOnBothSidesOfTheSurface) {
  const Scene s(shapes::box(Vec3(-0.02, -0.02, -0.02), Vec3(0.02, 0.02, 0), 16));
  for (double height : {1.9e-3, 1.3e-3, 1.0e-3, 0.4e-3, -0.2e-3, -1.5e-3, -2.5e-3}) {
    const Pose at{Vec3(0.0011, 0.0017, height), Quat::Identity()};
    const auto found = detect(s, ball(1e-3), at, at);
    ASSERT_FALSE(found.empty()) << height;
    EXPECT_NEAR(min_gap(found), height - 1e-3, 1e-12);
    for (const auto& x : found) {
      EXPECT_NEAR((x.normal - Vec3::UnitZ()).norm(), 0, 1e-9) << height;
      EXPECT_NEAR(x.point.z(), 0, 1e-12);
      EXPECT_NEAR((at.apply(x.local) - x.point).norm(), 0, 1e-12);
      EXPECT_GE(x.start_gap, -1e-3 - 1e-12);
    }
  }
}

TEST(ToolCollider, NoGhostNormalsAtInnerEdgesOfAPlane) {
  const Scene s(shapes::box(Vec3(-0.02, -0.02, -0.02), Vec3(0.02, 0.02, 0), 40));
  Random r(1);
  for (int k = 0; k < 200; ++k) {
    const Pose at{Vec3(r.between(-0.01, 0.01), r.between(-0.01, 0.01), r.between(0.0011, 0.0018)),
                  from_rotation_vector(r.in_box(0.1))};
    for (const auto& pieces : {ball(1e-3), rod(0.01, 1e-3), blade()})
      for (const auto& x : detect(s, pieces, at, at)) EXPECT_GT(x.normal.z(), 0.999);
  }
}

TEST(ToolCollider, BallNearAnEdgeAndACornerOfABox) {
  const Scene s(shapes::box(Vec3(-0.02, -0.02, -0.02), Vec3(0, 0, 0), 10));
  const Vec3 edge(0.9e-3, -0.0051, 0.9e-3), corner(0.9e-3, 0.8e-3, 0.7e-3);
  auto found = detect(s, ball(5e-4), {edge, Quat::Identity()}, {edge, Quat::Identity()});
  ASSERT_FALSE(found.empty());
  for (const auto& x : found) EXPECT_NEAR((x.normal - Vec3(1, 0, 1).normalized()).norm(), 0, 1e-9);
  EXPECT_NEAR(min_gap(found), edge.norm() > 0 ? std::hypot(0.9e-3, 0.9e-3) - 5e-4 : 0, 1e-12);
  found = detect(s, ball(5e-4), {corner, Quat::Identity()}, {corner, Quat::Identity()});
  ASSERT_FALSE(found.empty());
  for (const auto& x : found) EXPECT_NEAR((x.normal - corner.normalized()).norm(), 0, 1e-9);
}

TEST(ToolCollider, ALyingRodHasContactsAtBothEnds) {
  // Two big triangles only: the corners of the core must do.
  const Scene s(shapes::box(Vec3(-0.05, -0.05, -0.02), Vec3(0.05, 0.05, 0), 1));
  const Quat lying(Eigen::AngleAxisd(M_PI / 2, Vec3::UnitY()));
  const Pose at{Vec3(-0.011, 0.003, 1.2e-3), lying};
  auto found = detect(s, rod(0.02, 1e-3), at, at);
  ContactSelection selection;
  std::uint64_t key = 0;
  selection.select(found, {.spacing = 2e-3, .advantage = 0, .max_contacts = 8, .max_per_piece = 4}, key);
  ASSERT_GE(found.size(), 2u);
  double low = 1, high = -1;
  for (const auto& x : found) {
    EXPECT_NEAR(x.gap, 0.2e-3, 1e-12);
    low = std::min(low, x.point.x());
    high = std::max(high, x.point.x());
  }
  EXPECT_NEAR(low, -0.011, 1e-9);
  EXPECT_NEAR(high, 0.009, 1e-9);
}

TEST(ToolCollider, ABladeThroughTheSurfaceIsPushedOutward) {
  const Scene s(shapes::sphere(Vec3(0, 0, -0.03), 0.03, 4));
  const Pose at{Vec3(0.001, 0.0005, -0.001), Quat::Identity()};  // tip a millimetre inside
  const auto found = detect(s, blade(), at, at);
  ASSERT_FALSE(found.empty());
  EXPECT_LT(min_gap(found), -0.5e-3);
  for (const auto& x : found) {
    if (x.gap < 0) {
      EXPECT_GT(x.normal.z(), 0.9);
    }
    EXPECT_GE(x.start_gap, -1e-3 - 1e-15);
  }
}

TEST(ToolCollider, ALongMoveMeetsTheSurfaceItWouldPassThrough) {
  const Scene plate(shapes::box(Vec3(-0.03, -0.03, -0.001), Vec3(0.03, 0.03, 0), 24));
  Random r(3);
  for (int k = 0; k < 300; ++k) {
    const Quat turn = from_rotation_vector(r.in_box(1.5));
    const Pose start{Vec3(r.between(-0.01, 0.01), r.between(-0.01, 0.01), 0.0045), Quat::Identity()};
    const Pose free{start.p + Vec3(r.between(-0.003, 0.003), r.between(-0.003, 0.003), -0.009),
                    from_rotation_vector(r.in_box(0.1))};
    (void)turn;
    for (const auto& pieces : {ball(1e-3), rod(0.01, 1e-3), blade()}) {
      const auto found = detect(plate, pieces, start, free);
      // Some row must forbid the free motion, pointing up.
      double most = 0;
      for (const auto& x : found) {
        EXPECT_GT(x.normal.z(), 0.99);
        EXPECT_GE(x.start_gap, -1e-6);
        const Vec3 moved = free.apply(x.local) - start.apply(x.local);
        most = std::min(most, x.start_gap + x.normal.dot(moved));
      }
      EXPECT_LT(most, -4e-3);
    }
  }
}

TEST(ToolCollider, AFreeFlightPastACornerIsNotHindered) {
  // Over the edge and down beside the box in one step: nothing is met.
  const Scene s(shapes::box(Vec3(-0.02, -0.02, -0.02), Vec3(0, 0.02, 0), 10));
  const Pose start{Vec3(0.004, 0, 0.004), Quat::Identity()}, free{Vec3(0.004, 0, -0.004), Quat::Identity()};
  EXPECT_TRUE(detect(s, ball(1e-3), start, free).empty());
}

TEST(ToolCollider, SlidingFastIntoAWallFindsTheWall) {
  // Rests on the floor of a step and moves 6 mm towards its wall, pressed down by 3 mm.
  const Scene s(shapes::joined(shapes::box(Vec3(-0.02, -0.02, -0.01), Vec3(0.02, 0.02, 0), 16),
                               shapes::box(Vec3(0.004, -0.02, 0.0005), Vec3(0.02, 0.02, 0.01), 16)));
  const Pose start{Vec3(0, 0, 1e-3), Quat::Identity()}, free{Vec3(0.006, 0, -0.002), Quat::Identity()};
  bool floor = false, side = false;
  for (const auto& x : detect(s, ball(1e-3), start, free)) {
    floor = floor || x.normal.z() > 0.99;
    if (x.normal.x() < -0.99) {
      side = true;
      EXPECT_NEAR(x.start_gap, 0.003, 1e-9);
    }
  }
  EXPECT_TRUE(floor);
  EXPECT_TRUE(side);
}

TEST(ToolCollider, MovingTissueComingAtARestingToolIsSeen) {
  Scene s(shapes::box(Vec3(-0.02, -0.02, -0.02), Vec3(0.02, 0.02, 0), 10));
  std::vector<Vec3> up(s.shape.vertices.size(), Vec3(0, 0, 0.004));
  s.mesh.update(s.shape.vertices, up);
  const Pose at{Vec3(0, 0, 0.004), Quat::Identity()};
  const auto found = detect(s, ball(1e-3), at, at);
  ASSERT_FALSE(found.empty());
  for (const auto& x : found) EXPECT_NEAR(x.start_gap, 0.003, 1e-9);
}

TEST(RoundedPiece, ABladeKeepsItsSize) {
  const RoundedPiece r = rounded(blade()[0]);
  EXPECT_NEAR(r.radius, 0.45 * 4e-4, 1e-12);
  double x = 0, y = 0, z = 0;
  for (const Vec3& p : r.core) {
    x = std::max(x, std::abs(p.x()) + r.radius);
    y = std::max(y, std::abs(p.y()) + r.radius);
    z = std::max(z, p.z() + r.radius);
  }
  EXPECT_NEAR(x, 2e-4, 1e-9);
  EXPECT_NEAR(y, 4e-3, 1e-9);
  EXPECT_NEAR(z, 0.03, 1e-9);
}

TEST(TissueCollider, FacingBoxesHaveTheirGapAndOverlapsTheirDepth) {
  for (double gap : {0.3e-3, 0.0, -0.4e-3}) {
    const Scene a(shapes::box(Vec3(-0.01, -0.01, gap), Vec3(0.01, 0.01, 0.02), 10));
    const Scene b(shapes::box(Vec3(-0.02, -0.02, -0.02), Vec3(0.02, 0.02, 0), 13));
    TissueCollider c(sample_vertices(a.shape.vertices, a.shape.triangles, 2e-3), a.shape.vertices,
                     b.mesh.triangle_count());
    std::vector<Proximity> out;
    c.detect(a.mesh, b.mesh, {}, out);
    int faces = 0;
    for (const auto& x : out) {
      if (a.shape.vertices[std::size_t(x.vertex)].z() != gap) continue;
      ++faces;
      EXPECT_NEAR(x.gap, gap, 1e-12);
      EXPECT_NEAR((x.normal - Vec3::UnitZ()).norm(), 0, 1e-9);
    }
    EXPECT_GE(faces, 81);
  }
}

TEST(TissueCollider, SamplesAreEvenAndCover) {
  const TriMesh m = shapes::sphere(Vec3::Zero(), 0.03, 5);
  const auto samples = sample_vertices(m.vertices, m.triangles, 3e-3);
  for (std::size_t i = 0; i < samples.size(); ++i)
    for (std::size_t j = 0; j < i; ++j)
      EXPECT_GE((m.vertices[std::size_t(samples[i])] - m.vertices[std::size_t(samples[j])]).norm(), 3e-3);
  for (const Vec3& v : m.vertices) {
    double least = 1;
    for (int s : samples) least = std::min(least, (m.vertices[std::size_t(s)] - v).norm());
    EXPECT_LT(least, 3e-3);
  }
}

TEST(ContactSelection, KeepsKeysAndTangentsWhileAContactSlides) {
  ContactSelection selection;
  std::uint64_t next = 0;
  Vec3 tangent = Vec3::Zero();
  std::uint64_t key = 0;
  for (int step = 0; step < 50; ++step) {
    std::vector<Proximity> all(3);
    for (int i = 0; i < 3; ++i) {
      all[std::size_t(i)].piece = 0;
      all[std::size_t(i)].gap = 1e-4 * i;
      all[std::size_t(i)].local = all[std::size_t(i)].point = Vec3(2e-4 * step + 0.5e-3 * i, 0, 0);
      all[std::size_t(i)].normal = Vec3(std::sin(0.02 * step), 0, std::cos(0.02 * step));
    }
    selection.select(all, {}, next);
    ASSERT_EQ(all.size(), 1u);  // the others are within the spacing
    EXPECT_NEAR(all[0].tangent.norm(), 1, 1e-15);
    EXPECT_NEAR(all[0].tangent.dot(all[0].normal), 0, 1e-15);
    if (step > 0) {
      EXPECT_EQ(all[0].key, key);
      EXPECT_GT(all[0].tangent.dot(tangent), 0.99);
    }
    key = all[0].key;
    tangent = all[0].tangent;
  }
  EXPECT_EQ(next, 1u);
}

TEST(ContactSelection, SpreadsAndCaps) {
  Random r(2);
  std::vector<Proximity> all(400);
  for (auto& x : all) {
    x.piece = 0;
    x.point = x.local = r.in_box(0.01);
    x.gap = r.between(0, 1e-3);
  }
  const double least = min_gap(all);
  ContactSelection selection;
  std::uint64_t next = 0;
  selection.select(all, {.spacing = 4e-3, .advantage = 0, .max_contacts = 6, .max_per_piece = 6}, next);
  ASSERT_EQ(all.size(), 6u);
  EXPECT_EQ(all[0].gap, least);
  for (std::size_t i = 0; i < all.size(); ++i)
    for (std::size_t j = 0; j < i; ++j) EXPECT_GE((all[i].point - all[j].point).norm(), 4e-3);
}

}  // namespace
}  // namespace insula
