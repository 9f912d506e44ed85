// SPDX-License-Identifier: GPL-3.0-or-later
// Pieces against the vertices of a thin wall: gaps in closed form, a sheet between closing jaws, a fast blade, the
// direction back.
#include "core/collision/colliders/vertex_collider.h"

#include <gtest/gtest.h>

#include <set>

#include "core/collision/colliders/contact_selection.h"
#include "core/collision/colliders/sheet_for_test.h"
#include "core/collision/shapes/shapes_for_test.h"
#include "core/testing/held.h"

namespace insula {
namespace {

using test::Sheet;

constexpr double half_x = 1.5e-3, half_y = 1e-3, half_z = 0.5e-3;  // of a jaw

std::vector<ConvexPiece> jaw() { return {test::box_piece(half_x, half_y, half_z)}; }
Pose at(const Vec3& p) { return {p, Quat::Identity()}; }

constexpr double wall = 0.15e-3;  // half the wall's thickness
ToolContactSettings settings(double alarm = 0.3e-3) {
  ToolContactSettings s;
  s.alarm = alarm;
  s.offset = wall;
  s.max_correction = 1e-3;
  return s;
}

/// Gap at the end of a step in which the tool goes by `motion` (translation) and the wall by what it is free to.
double end_gap(const Proximity& c, const Sheet& sheet, const Vec3& motion) {
  return c.start_gap + c.normal.dot(motion - sheet.free[std::size_t(c.vertex)]);
}

TEST(VertexCollider, EveryVertexNearABallHasItsExactGapAndNoOtherHasOne) {
  const Sheet sheet;
  const double radius = 0.8e-3, alarm = 0.2e-3;
  VertexCollider collider({{"ball", {Vec3(0.1e-3, 0, 0)}, radius}}, sheet.triangles, sheet.rest);
  const Vec3 centre(0.07e-3, -0.11e-3, 0.9e-3);  // the ball's own centre stands 0.1 mm off its frame
  std::vector<Proximity> found;
  collider.detect(sheet.mesh, at(centre - Vec3(0.1e-3, 0, 0)), at(centre - Vec3(0.1e-3, 0, 0)), settings(alarm), found);
  std::set<int> seen;
  for (const Proximity& c : found) {
    const Vec3& x = sheet.rest[std::size_t(c.vertex)];
    EXPECT_TRUE(seen.insert(c.vertex).second);
    EXPECT_TRUE(test::held("gaps of vertices near a ball, m", std::abs(c.gap - ((x - centre).norm() - radius - wall)),
                           1, 1e-15));
    EXPECT_EQ(c.start_gap, c.gap);
    EXPECT_LT((c.normal - (centre - x).normalized()).norm(), 1e-12);
    EXPECT_LT((sheet.mesh.point(c.triangle, c.bary) - x).norm(), 1e-15);
    EXPECT_EQ(c.time, 0);
  }
  std::set<int> expected;
  for (int v = 0; v < sheet.count(); ++v)
    if ((sheet.rest[std::size_t(v)] - centre).norm() - radius - wall <= alarm) expected.insert(v);
  EXPECT_EQ(seen, expected);
  EXPECT_GT(expected.size(), 20u);
  EXPECT_TRUE(
      std::is_sorted(found.begin(), found.end(), [](const auto& a, const auto& b) { return a.vertex < b.vertex; }));
}

TEST(VertexCollider, ASheetBetweenClosingJawsIsHeldFromBothSides) {
  const Sheet sheet;
  VertexCollider upper(jaw(), sheet.triangles, sheet.rest), lower(jaw(), sheet.triangles, sheet.rest);
  std::vector<Proximity> above, below;
  // From well open to jaws that overlap the wall by nearly all its thickness: sides never change.
  for (double face = 0.4e-3; face > 0.02e-3; face -= 0.02e-3) {
    above.clear();
    below.clear();
    upper.detect(sheet.mesh, at({0, 0, half_z + face}), at({0, 0, half_z + face - 0.02e-3}), settings(), above);
    lower.detect(sheet.mesh, at({0, 0, -half_z - face}), at({0, 0, -half_z - face + 0.02e-3}), settings(), below);
    for (const auto& [contacts, up] : {std::pair{&above, 1.0}, std::pair{&below, -1.0}}) {
      std::set<int> seen;
      for (const Proximity& c : *contacts) {
        const Vec3& x = sheet.rest[std::size_t(c.vertex)];
        EXPECT_TRUE(seen.insert(c.vertex).second);
        EXPECT_GT(up * c.normal.z(), 0) << face;
        if (std::abs(x.x()) > half_x - 0.25e-3 || std::abs(x.y()) > half_y - 0.25e-3)
          continue;  // the jaw's edges are round
        EXPECT_LT((c.normal - Vec3(0, 0, up)).norm(), 1e-6) << face;
        EXPECT_NEAR(c.gap, face - wall, 1e-9);
      }
      for (int v = 0; v < sheet.count(); ++v) {
        const Vec3& x = sheet.rest[std::size_t(v)];
        if (std::abs(x.x()) < half_x - 0.25e-3 && std::abs(x.y()) < half_y - 0.25e-3) {
          EXPECT_TRUE(seen.count(v)) << face;
        }
      }
    }
  }
}

TEST(VertexCollider, AFastBladeMeetsTheSheetItWouldHavePassed) {
  const Sheet sheet;
  VertexCollider collider(jaw(), sheet.triangles, sheet.rest);
  for (const double swept : {3e-3, 8e-3, 30e-3}) {
    collider.reset();
    const Vec3 from(0.1e-3, 0, half_z + 1.5e-3), motion(0, 0, -swept);
    std::vector<Proximity> found;
    collider.detect(sheet.mesh, at(from), at(from + motion), settings(), found);
    std::set<int> seen;
    for (const Proximity& c : found) {
      seen.insert(c.vertex);
      EXPECT_GT(c.time, 0);
      EXPECT_LT(c.time, 1);
      EXPECT_GE(c.gap, -1e-6);
      EXPECT_LE(c.gap, 0.2 * 0.3e-3 + 1e-12);
      EXPECT_GT(c.normal.z(), 0) << "of the side it came from";
      EXPECT_LT(end_gap(c, sheet, motion), 0) << "the row lets the blade through";
      // With the motion cut where the row says so, the jaw stands before the wall.
      const double cut = c.start_gap / -c.normal.dot(motion);
      EXPECT_GT(cut, 0);
      EXPECT_LT(cut, 1);
      if (c.normal.z() > 1 - 1e-9) {
        EXPECT_NEAR(cut * swept, 1.5e-3 - wall, 1e-8);
      }
    }
    for (int v = 0; v < sheet.count(); ++v) {
      const Vec3 x = sheet.rest[std::size_t(v)] - from;
      if (std::abs(x.x()) < half_x - 0.25e-3 && std::abs(x.y()) < half_y - 0.25e-3) {
        EXPECT_TRUE(seen.count(v)) << "passed vertex " << v;
      }
    }
  }
}

TEST(VertexCollider, AFastSheetMeetsTheBladeAtRest) {
  Sheet sheet;
  for (Vec3& u : sheet.free) u = Vec3(0, 0, 5e-3);
  sheet.update();
  VertexCollider collider(jaw(), sheet.triangles, sheet.rest);
  std::vector<Proximity> found;
  collider.detect(sheet.mesh, at({0, 0, half_z + 2e-3}), at({0, 0, half_z + 2e-3}), settings(), found);
  ASSERT_GT(found.size(), 40u);
  for (const Proximity& c : found) {
    EXPECT_LT(end_gap(c, sheet, Vec3::Zero()), 0);
    if (c.normal.z() > 1 - 1e-9) {
      EXPECT_NEAR(c.start_gap, 2e-3 - wall, 1e-8);
    }
  }
}

TEST(VertexCollider, WhatGoesAwayOrPassesBesideGivesNothing) {
  const Sheet sheet;
  VertexCollider collider(jaw(), sheet.triangles, sheet.rest);
  std::vector<Proximity> found;
  const Vec3 above(0, 0, half_z + 1e-3), beside(8e-3, 0, half_z + 1e-3);
  collider.detect(sheet.mesh, at(above), at(above + Vec3(0, 0, 5e-3)), settings(), found);
  collider.detect(sheet.mesh, at(above), at(above + Vec3(1e-3, 0, 0)), settings(), found);
  collider.detect(sheet.mesh, at(beside), at(beside + Vec3(0, 0, -5e-3)), settings(), found);
  EXPECT_TRUE(found.empty());
}

// The jaw's core goes past a vertex that it kept out: the vertex is sent back to its side, whether inside the core or
// through it.
TEST(VertexCollider, AVertexInsideTheCoreGoesBackTheWayItCame) {
  Sheet sheet;
  VertexCollider collider(jaw(), sheet.triangles, sheet.rest);
  const int v = sheet.count() / 2;
  const Pose pose = at({0, 0, half_z + 0.2e-3});
  const auto contact_of = [&](double z) {
    sheet.now[std::size_t(v)] = Vec3(0, 0, z);
    sheet.update();
    std::vector<Proximity> found;
    collider.detect(sheet.mesh, pose, pose, settings(), found);
    for (const Proximity& c : found)
      if (c.vertex == v) return c;
    return Proximity{};
  };
  const Vec3 up = Vec3::UnitZ();
  ASSERT_LT((contact_of(0).normal - up).norm(), 1e-6);
  const double middle = pose.p.z();
  for (const double z : {middle, middle + 0.2e-3, 2 * middle - 0.05e-3, 2 * middle + 0.1e-3}) {
    const Proximity c = contact_of(z);
    ASSERT_EQ(c.vertex, v) << z << ": no contact";
    EXPECT_LT((c.normal - up).norm(), 1e-6) << z;
    EXPECT_LT(c.gap, 0) << z;
    EXPECT_GE(c.start_gap, -settings().max_correction);
  }
  // Once it is back outside all is as before; far away, the memory is gone and the other side is as good.
  EXPECT_NEAR(contact_of(0).gap, 0.2e-3 - wall, 1e-9);
  EXPECT_EQ(contact_of(10e-3).vertex, -1);
  EXPECT_LT((contact_of(2 * middle).normal + up).norm(), 1e-6);
}

TEST(VertexCollider, TheMemoryTurnsWithThePieces) {
  Sheet sheet;
  VertexCollider collider(jaw(), sheet.triangles, sheet.rest);
  const int v = sheet.count() / 2;
  std::vector<Proximity> found;
  const Pose pose = at({0, 0, half_z + 0.2e-3});
  collider.detect(sheet.mesh, pose, pose, settings(), found);
  // Everything turns by 90 degrees about x; the vertex now lies within the core.
  const Quat turn = from_rotation_vector(Vec3(0.5 * 3.14159265358979323846, 0, 0));
  for (Vec3& x : sheet.now) x = turn * x;
  const Pose turned{turn * pose.p, turn};
  sheet.now[std::size_t(v)] = turned.p;
  sheet.update();
  found.clear();
  collider.detect(sheet.mesh, turned, turned, settings(), found);
  int seen = 0;
  for (const Proximity& c : found)
    if (c.vertex == v) {
      ++seen;
      EXPECT_LT((c.normal - turn * Vec3::UnitZ()).norm(), 1e-6);
    }
  EXPECT_EQ(seen, 1);
}

TEST(VertexCollider, OfSeveralPiecesTheNearestHasTheVertex) {
  const Sheet sheet;
  const double r = 0.5e-3;
  const Vec3 a(-0.6e-3, 0, r + wall + 0.05e-3), b(0.6e-3, 0, r + wall + 0.1e-3);
  VertexCollider collider({{"a", {a}, r}, {"b", {b}, r}}, sheet.triangles, sheet.rest);
  std::vector<Proximity> found;
  collider.detect(sheet.mesh, Pose{}, Pose{}, settings(), found);
  ASSERT_GT(found.size(), 10u);
  int of[2] = {0, 0};
  for (const Proximity& c : found) {
    const Vec3& x = sheet.rest[std::size_t(c.vertex)];
    EXPECT_EQ(c.piece, (x - a).norm() <= (x - b).norm() ? 0 : 1);
    ++of[c.piece];
  }
  EXPECT_GT(of[0], 3);
  EXPECT_GT(of[1], 3);
}

// A jaw that slides along the wall: every vertex that stays near keeps the name and the tangent of its contact.
TEST(VertexCollider, KeysLastAsLongAsTheVertexIsNear) {
  const Sheet sheet;
  VertexCollider collider(jaw(), sheet.triangles, sheet.rest);
  ContactSelection selection;
  selection.reserve(2048, 200);
  std::uint64_t next = 0;
  std::map<int, std::uint64_t> last;
  std::set<std::uint64_t> all;
  int kept = 0;
  for (int i = 0; i < 30; ++i) {
    const Vec3 p(0.03e-3 * i, 0.02e-3 * i, half_z + 0.2e-3);
    std::vector<Proximity> found;
    collider.detect(sheet.mesh, at(p), at(p), settings(), found);
    selection.select(found, {.spacing = 0, .advantage = 0, .max_contacts = 200, .max_per_piece = 200}, next);
    ASSERT_GT(found.size(), 40u);
    std::map<int, std::uint64_t> now;
    for (const Proximity& c : found) {
      EXPECT_TRUE(now.emplace(c.vertex, c.key).second);
      const auto before = last.find(c.vertex);
      if (before != last.end()) {
        EXPECT_EQ(before->second, c.key);
        ++kept;
      } else {
        EXPECT_TRUE(all.insert(c.key).second) << "a name given twice";
      }
    }
    last = now;
  }
  EXPECT_GT(kept, 1000);
}

TEST(VertexCollider, SameInputSameBits) {
  const Sheet sheet;
  const auto run = [&] {
    VertexCollider collider(jaw(), sheet.triangles, sheet.rest);
    std::vector<Proximity> found;
    for (int i = 0; i < 10; ++i) {
      const Pose start{Vec3(0, 0, half_z + 1e-3 - 0.1e-3 * i), from_rotation_vector(Vec3(0.02 * i, 0.1, 0))};
      collider.detect(sheet.mesh, start, displaced(start, (Vec6() << 0, 0, -1e-3, 0.05, 0, 0.02).finished()),
                      settings(), found);
    }
    return found;
  };
  const auto a = run(), b = run();
  ASSERT_EQ(a.size(), b.size());
  ASSERT_GT(a.size(), 100u);
  for (std::size_t i = 0; i < a.size(); ++i) {
    EXPECT_EQ(a[i].vertex, b[i].vertex);
    EXPECT_EQ(a[i].gap, b[i].gap);
    EXPECT_EQ(a[i].start_gap, b[i].start_gap);
    EXPECT_EQ(a[i].normal, b[i].normal);
  }
}

}  // namespace
}  // namespace insula
