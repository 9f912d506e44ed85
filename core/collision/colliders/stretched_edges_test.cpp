// SPDX-License-Identifier: GPL-3.0-or-later
// Points within stretched edges: where they are, how far apart, and that a blade does not slip between the ends of an
// edge.
#include "core/collision/colliders/stretched_edges.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <set>

#include "core/collision/colliders/sheet_for_test.h"
#include "core/collision/colliders/vertex_collider.h"
#include "core/testing/held.h"

namespace insula {
namespace {

/// A sheet with squares of 0.5 mm whose vertices may be moved.
struct Sheet : test::Sheet {
  Sheet() : test::Sheet(9, 0.5e-3) {}
  int middle() const { return int(rest.size()) / 2; }
  /// Draws the middle vertex out of the sheet.
  void draw_out(double height) {
    now[std::size_t(middle())].z() = height;
    update();
  }
  std::vector<int> points() const {
    const StretchedEdges edges(rest, triangles);
    std::vector<int> all;
    for (int t = 0; t < mesh.triangle_count(); ++t) edges.append_points(mesh, t, all);
    return all;
  }
  /// The two vertices between which a point lies, and its weights there.
  std::map<int, double> ends_of(int point) const {
    const auto [t, bary] = StretchedEdges::place(point);
    std::map<int, double> weights;
    for (int k = 0; k < 3; ++k)
      if (bary[k] > 0) weights[triangles[std::size_t(t)][std::size_t(k)]] = bary[k];
    return weights;
  }
};

TEST(StretchedEdges, AWallThatIsHardlyStretchedHasNone) {
  Sheet sheet;
  EXPECT_TRUE(sheet.points().empty());
  for (std::size_t i = 0; i < sheet.now.size(); ++i) sheet.now[i] = 1.7 * sheet.rest[i];
  sheet.update();
  EXPECT_TRUE(sheet.points().empty());
}

// A wall stretched alike everywhere: all edges have 1, 3 or 7 points, and both triangles of an edge give the same ones.
TEST(StretchedEdges, BothTrianglesOfAnEdgeGiveItsPointsEvenlySpaced) {
  for (const auto& [stretch, count] : {std::pair{2.0, 1}, {5.0, 3}, {9.0, 7}}) {
    Sheet sheet;
    for (std::size_t i = 0; i < sheet.now.size(); ++i) sheet.now[i] = stretch * sheet.rest[i];
    sheet.update();
    std::map<std::pair<int, int>, std::vector<double>> shares;  // of the edge from its lower vertex
    std::map<int, int> times;
    for (const int p : sheet.points()) {
      ASSERT_LT(StretchedEdges::place(p).triangle, sheet.mesh.triangle_count());
      const std::map<int, double> weights = sheet.ends_of(p);
      ASSERT_EQ(weights.size(), 2u);
      EXPECT_NEAR(weights.begin()->second + weights.rbegin()->second, 1, 1e-15);
      if (++times[p] == 1)
        shares[{weights.begin()->first, weights.rbegin()->first}].push_back(weights.rbegin()->second);
    }
    std::map<std::pair<int, int>, int> faces;
    for (const auto& t : sheet.triangles)
      for (int k = 0; k < 3; ++k) {
        const int a = t[std::size_t(k)], b = t[std::size_t((k + 1) % 3)];
        ++faces[{std::min(a, b), std::max(a, b)}];
      }
    // The diagonals are longer at rest, but are stretched as much.
    ASSERT_EQ(shares.size(), faces.size());
    for (auto& [of, at] : shares) {
      std::sort(at.begin(), at.end());
      ASSERT_EQ(int(at.size()), count);
      for (int i = 0; i < count; ++i)
        EXPECT_TRUE(test::held("places of points within stretched edges",
                               std::abs(at[std::size_t(i)] - (i + 1.0) / (count + 1)), 1, 1e-15));
    }
    for (const auto& [p, n] : times) {
      const std::map<int, double> ends = sheet.ends_of(p);
      EXPECT_EQ(n, (faces[{ends.begin()->first, ends.rbegin()->first}]));
    }
  }
}

// One vertex drawn out of a sheet: its edges alone have points.
TEST(StretchedEdges, OnlyEdgesOfADrawnOutVertexHavePoints) {
  Sheet sheet;
  sheet.draw_out(3e-3);
  const auto points = sheet.points();
  EXPECT_EQ(std::set<int>(points.begin(), points.end()).size(), 6u * 3);
  for (const int p : points) EXPECT_TRUE(sheet.ends_of(p).count(sheet.middle()));
}

// A blade lies beside a drawn-out vertex's edges, between their ends. The vertices alone would let it in. Each point
// that faces the blade's plane has the gap of a point before a plane.
TEST(StretchedEdges, ABladeBetweenTheEndsOfAnEdgeTouchesIt) {
  constexpr double half_wall = 0.15e-3, half_x = 0.4e-3, face_at = 0.3e-3;
  Sheet sheet;
  sheet.draw_out(4e-3);
  const Pose pose{Vec3(face_at + half_x, 0, 2e-3), Quat::Identity()};
  VertexCollider collider({test::box_piece(half_x, 2e-3, 0.7e-3)}, sheet.triangles, sheet.rest);
  const auto found_with = [&](double offset) {
    std::vector<Proximity> found;
    collider.reset();
    collider.detect(sheet.mesh, pose, pose, {.alarm = 0.3e-3, .max_correction = 1e-3, .offset = offset}, found);
    return found;
  };
  EXPECT_TRUE(found_with(0).empty()) << "the surface of a solid has its triangles' contacts";
  const auto found = found_with(half_wall);
  ASSERT_FALSE(found.empty());
  int faced = 0;
  for (const Proximity& c : found) {
    EXPECT_GE(c.vertex, int(sheet.rest.size()));
    const Vec3 x = sheet.mesh.point(c.triangle, c.bary);
    EXPECT_LT((c.point - x).norm(), 1e-15);
    if (std::abs(x.z() - pose.p.z()) > 0.5e-3) continue;  // the blade's edges are round
    ++faced;
    EXPECT_NEAR(c.normal.x(), 1, 1e-9);
    EXPECT_TRUE(test::held("gaps of a blade between an edge's ends, m", std::abs(c.gap - (face_at - x.x() - half_wall)),
                           1, 1e-9));
  }
  EXPECT_GE(faced, 6);
}

// A point that a blade has kept out goes back to its side when the blade went over it, as a vertex does.
TEST(StretchedEdges, APointRemembersItsSide) {
  Sheet sheet;
  sheet.draw_out(4e-3);
  VertexCollider collider({test::box_piece(0.4e-3, 2e-3, 0.7e-3)}, sheet.triangles, sheet.rest);
  const ToolContactSettings settings{.alarm = 0.3e-3, .max_correction = 1e-3, .offset = 0.15e-3};
  int seen = 0;
  std::set<int> known;
  for (const double x : {0.65e-3, 0.45e-3, 0.1e-3, -0.2e-3}) {
    std::vector<Proximity> found;
    const Pose pose{Vec3(x, 0, 2e-3), Quat::Identity()};
    collider.detect(sheet.mesh, pose, pose, settings, found);
    for (const Proximity& c : found) {
      if (!known.count(c.vertex) || std::abs(c.point.z() - pose.p.z()) > 0.4e-3) continue;
      ++seen;
      EXPECT_GT(c.normal.x(), 0.9) << x;
      if (x < 0.5e-3) {
        EXPECT_LT(c.gap, 0);
      }
    }
    if (x == 0.65e-3)
      for (const Proximity& c : found) known.insert(c.vertex);
  }
  EXPECT_GE(seen, 6);
}

}  // namespace
}  // namespace insula
