// SPDX-License-Identifier: GPL-3.0-or-later
// A wall against itself: exact gaps across the lumen and outside, crossings, the look-ahead of a push.
#include "core/collision/colliders/self_collider.h"

#include <gtest/gtest.h>

#include "core/collision/colliders/contact_selection.h"
#include "core/collision/shapes/shapes_for_test.h"
#include "core/testing/held.h"

namespace insula {
namespace {

constexpr double thickness = 0.3e-3;
Workers workers(2);

/// A flat box, 2 mm high at rest; height() presses it.
struct Flat {
  TriMesh rest = shapes::box(Vec3(-5e-3, -5e-3, -1e-3), Vec3(5e-3, 5e-3, 1e-3), 8);
  std::vector<Vec3> now = rest.vertices, free = std::vector<Vec3>(rest.vertices.size(), Vec3::Zero());
  CollisionMesh mesh;
  SelfCollider collider{rest.vertices, rest.triangles, 0.9e-3, thickness};
  Flat() { mesh.build(rest.vertices, rest.triangles); }
  void height(double h) {
    for (std::size_t i = 0; i < now.size(); ++i) now[i].z() = rest.vertices[i].z() * h / 2e-3;
  }
  std::vector<Proximity> detect(const SelfContactSettings& settings = {}) {
    std::vector<Proximity> out;
    mesh.update(now, free);
    collider.detect(mesh, settings, out, workers);
    return out;
  }
  bool top(const Proximity& x) const { return rest.vertices[std::size_t(x.vertex)].z() > 0.99e-3; }
};

TEST(SelfCollider, WallsPressedTogetherHaveTheExactGapAlsoWhenTheyHaveCrossed) {
  Flat f;
  for (double h : {0.75e-3, 0.4e-3, 0.3e-3, 0.1e-3, 0.0, -0.2e-3, -1e-3}) {
    f.height(h);
    const auto found = f.detect();
    int both[2] = {0, 0};
    for (const Proximity& x : found) {
      const bool top = f.top(x);
      if (std::abs(f.rest.vertices[std::size_t(x.vertex)].z()) < 0.99e-3) continue;
      ++both[top];
      EXPECT_TRUE(test::held("gaps of a wall with itself, m", std::abs(x.gap - (h - thickness)), 1, 1e-12)) << h;
      EXPECT_NEAR((x.normal - (top ? 1.0 : -1.0) * Vec3::UnitZ()).norm(), 0, 1e-9) << h;
      EXPECT_GE(x.start_gap, -0.3e-3 - 1e-15);
      EXPECT_EQ(x.side, SelfCollider::inner);
    }
    EXPECT_GE(both[0], 30) << h;
    EXPECT_GE(both[1], 30) << h;
  }
}

// The upper wall, pressed on the lower one, tilts at once: the normals of what presses follow by three tenths a look,
// those of what only comes near are where the walls are.
TEST(SelfCollider, NormalsOfWhatPressesTurnSlowly) {
  for (const double h : {0.2e-3, 0.5e-3}) {
    Flat f;
    f.height(h);
    SelfContactSettings settings;
    settings.normal_under_relaxation = true;
    f.detect(settings);
    const double slope = 0.05;
    for (std::size_t i = 0; i < f.now.size(); ++i) f.now[i].z() += slope * f.now[i].x();
    Vec3 flat = Vec3::UnitZ();
    const Vec3 tilted = Vec3(-slope, 0, 1).normalized();
    for (int look = 0; look < 4; ++look) {
      flat = (flat + 0.3 * (tilted - flat)).normalized();
      int seen = 0;
      for (const Proximity& x : f.detect(settings)) {
        const Vec3& rest = f.rest.vertices[std::size_t(x.vertex)];
        if (std::abs(rest.x()) > 3e-3 || std::abs(rest.y()) > 3e-3) continue;
        ++seen;
        const Vec3 up = f.top(x) ? x.normal : Vec3(-x.normal);
        EXPECT_NEAR((up - (h < thickness ? flat : tilted)).norm(), 0, 1e-9) << "look " << look << ", height " << h;
      }
      EXPECT_GE(seen, 30);
    }
  }
}

// The upper wall tilts to and fro at every look: the normals follow by three tenths of each turn for sixty looks, then
// by three hundredths, until what presses lets go.
TEST(SelfCollider, NormalsThatSwingYieldATenth) {
  Flat f;
  f.height(0.2e-3);
  SelfContactSettings settings;
  settings.normal_under_relaxation = true;
  f.detect(settings);
  const auto level = f.now;
  const double slope = 0.05;
  const auto tilt = [&](double by) {
    f.now = level;
    for (std::size_t i = 0; i < f.now.size(); ++i) f.now[i].z() += by * f.now[i].x();
  };
  const auto check = [&](const Vec3& up, int look) {
    int seen = 0;
    for (const Proximity& x : f.detect(settings)) {
      const Vec3& rest = f.rest.vertices[std::size_t(x.vertex)];
      if (std::abs(rest.x()) > 3e-3 || std::abs(rest.y()) > 3e-3) continue;
      ++seen;
      ASSERT_NEAR(((f.top(x) ? x.normal : Vec3(-x.normal)) - up).norm(), 0, 1e-9) << "look " << look;
    }
    EXPECT_GE(seen, 30);
  };
  Vec3 up = Vec3::UnitZ();
  for (int look = 0; look < 100; ++look) {
    const double by = look % 2 ? -slope : slope;
    tilt(by);
    up = (up + (look < 60 ? 0.3 : 0.03) * (Vec3(-by, 0, 1).normalized() - up)).normalized();
    check(up, look);
  }
  // Still slow while it presses on, as fast as ever once it has been off.
  tilt(slope);
  for (int look = 100; look < 110; ++look) {
    up = (up + 0.03 * (Vec3(-slope, 0, 1).normalized() - up)).normalized();
    check(up, look);
  }
  f.now = level;
  for (std::size_t i = 0; i < f.now.size(); ++i) f.now[i].z() += f.now[i].z() > 0 ? 0.1e-3 : -0.1e-3;
  f.detect(settings);
  f.now = level;
  f.detect(settings);
  tilt(slope);
  check((Vec3::UnitZ() + 0.3 * (Vec3(-slope, 0, 1).normalized() - Vec3::UnitZ())).normalized(), 110);
}

TEST(SelfCollider, NothingAtRestAndNothingFarOff) {
  for (const TriMesh& m : {shapes::sphere(Vec3::Zero(), 2e-3, 3), shapes::sphere(Vec3::Zero(), 0.6e-3, 2),
                           shapes::box(Vec3::Zero(), Vec3(4e-3, 4e-3, 4e-3), 6)}) {
    CollisionMesh mesh;
    mesh.build(m.vertices, m.triangles);
    mesh.update(m.vertices, {});
    SelfCollider c(m.vertices, m.triangles, 0.2e-3, thickness);
    std::vector<Proximity> out;
    SelfContactSettings settings;
    settings.outer = true;
    settings.alarm = 0.1e-3;
    c.detect(mesh, settings, out, workers);
    EXPECT_TRUE(out.empty());
  }
  Flat f;
  f.height(0.85e-3);
  EXPECT_TRUE(f.detect().empty());
  // ... but what comes is seen.
  for (std::size_t i = 0; i < f.free.size(); ++i) f.free[i] = Vec3(0, 0, f.now[i].z() > 0 ? -0.2e-3 : 0.0);
  EXPECT_FALSE(f.detect().empty());
}

TEST(SelfCollider, TwoBranchesSideBySideAreOutsideOfEachOther) {
  const TriMesh upper = shapes::box(Vec3(-5e-3, -5e-3, 0), Vec3(5e-3, 5e-3, 2e-3), 8);
  const int above = int(upper.vertices.size());
  const TriMesh m = shapes::joined(upper, shapes::box(Vec3(-6e-3, -6e-3, -4e-3), Vec3(6e-3, 6e-3, -2e-3), 8));
  SelfCollider c(m.vertices, m.triangles, 0.9e-3, thickness);
  CollisionMesh mesh;
  mesh.build(m.vertices, m.triangles);
  SelfContactSettings settings;
  settings.outer = true;
  // Down to contact and through: once touching, a crossing is known for what it is.
  for (double distance : {0.6e-3, 0.4e-3, 0.2e-3, -0.3e-3}) {
    std::vector<Vec3> now = m.vertices;
    for (int i = 0; i < above; ++i) now[std::size_t(i)].z() += distance - 2e-3;
    mesh.update(now, {});
    std::vector<Proximity> out;
    c.detect(mesh, settings, out, workers);
    int count = 0;
    for (const Proximity& x : out) {
      EXPECT_EQ(x.side, SelfCollider::outer);
      if (x.vertex >= above) continue;
      ++count;
      EXPECT_NEAR(x.gap, distance - thickness, 1e-12);
      EXPECT_NEAR((x.normal - Vec3::UnitZ()).norm(), 0, 1e-9);
    }
    EXPECT_GE(count, 30) << distance;
  }
}

/// A box over one of large triangles, `apart` at rest; contacts of its vertices once they are `now` apart.
std::vector<Proximity> over_large_triangles(double apart, double now) {
  const TriMesh upper = shapes::box(Vec3(-5e-3, -5e-3, 0), Vec3(5e-3, 5e-3, 2e-3), 10);
  const int above = int(upper.vertices.size());
  const TriMesh m = shapes::joined(upper, shapes::box(Vec3(-6e-3, -6e-3, -2e-3 - apart), Vec3(6e-3, 6e-3, -apart), 2));
  SelfCollider c(m.vertices, m.triangles, 0.9e-3, thickness);
  CollisionMesh mesh;
  mesh.build(m.vertices, m.triangles);
  SelfContactSettings settings;
  settings.inner = false;
  settings.outer = true;
  std::vector<Proximity> out;
  std::vector<Vec3> places = m.vertices;
  for (int i = 0; i < above; ++i) places[std::size_t(i)].z() += now - apart;
  mesh.update(places, {});
  c.detect(mesh, settings, out, workers);
  std::erase_if(out, [&](const Proximity& x) { return x.vertex >= above; });
  return out;
}

// Their middles are millimetres apart; the triangles are not.
TEST(SelfCollider, LargeTrianglesThatAreNearAtRestAreNeighbours) {
  for (const double now : {0.59e-3, 0.4e-3, 0.2e-3}) EXPECT_TRUE(over_large_triangles(0.59e-3, now).empty()) << now;
  const auto found = over_large_triangles(0.61e-3, 0.2e-3);
  EXPECT_GE(found.size(), 20u);
  for (const Proximity& x : found) EXPECT_NEAR(x.gap, 0.2e-3 - thickness, 1e-12);
}

TEST(SelfCollider, ACrossingBeginsShallow) {
  const SelfContactSettings settings;
  const double most = settings.thickness + settings.alarm;
  const auto crossed = [](const std::vector<Proximity>& found) {
    int n = 0;
    for (const Proximity& x : found) n += x.gap < -thickness;
    return n;
  };
  for (const double depth : {0.1e-3, 0.99 * most, 1.01 * most, 2e-3}) {
    Flat fresh, known;
    fresh.height(-depth);
    known.height(0.4e-3);
    known.detect();
    known.height(-0.3e-3);  // seen to cross ...
    known.detect();
    known.height(-depth);  // ... it may be deeper
    EXPECT_EQ(crossed(fresh.detect()) > 30, depth < most) << depth;
    if (depth > most) {
      EXPECT_EQ(crossed(fresh.detect()), 0) << depth;
    }
    const auto found = known.detect();
    EXPECT_GT(crossed(found), 60) << depth;
    for (const Proximity& x : found)
      if (std::abs(known.rest.vertices[std::size_t(x.vertex)].z()) > 0.99e-3) {
        EXPECT_NEAR(x.gap, -depth - thickness, 1e-12);
      }
  }
}

TEST(SelfCollider, BehindAPressedPlaceIsTheOppositeWall) {
  Flat f;
  f.height(1.2e-3);
  f.mesh.update(f.now, {});
  int checked = 0;
  for (int tri = 0; tri < f.mesh.triangle_count(); ++tri) {
    const Vec3 bary(0.2, 0.3, 0.5), from = f.mesh.point(tri, bary);
    if (from.z() < 0.599e-3 || from.head<2>().cwiseAbs().maxCoeff() > 4e-3) continue;
    const Vec3 along = Vec3(0.1, 0.05, -1).normalized();
    const Opposite o = f.collider.opposite(f.mesh, tri, bary, along, 3e-3);
    ASSERT_GE(o.triangle, 0);
    EXPECT_NEAR(o.distance, 1.2e-3 / -along.z(), 1e-12);
    EXPECT_NEAR((f.mesh.point(o.triangle, o.bary) - from - o.distance * along).norm(), 0, 1e-12);
    EXPECT_LT(f.collider.opposite(f.mesh, tri, bary, along, 1.1e-3).triangle, 0);  // farther than asked for
    EXPECT_LT(f.collider.opposite(f.mesh, tri, bary, -along, 3e-3).triangle, 0);   // outside
    ++checked;
  }
  EXPECT_GT(checked, 50);
}

TEST(SelfCollider, SelectionTakesAPairOnceWhicheverSideFoundIt) {
  Flat f;
  f.height(0.3e-3);
  auto found = f.detect();
  ContactSelection selection;
  std::uint64_t key = 0;
  selection.select(
      found, {.spacing = 1.3e-3, .advantage = 0, .max_contacts = 100, .max_per_piece = 4, .both_ends = true}, key);
  EXPECT_GE(found.size(), 20u);
  for (std::size_t i = 0; i < found.size(); ++i)
    for (std::size_t j = 0; j < i; ++j) EXPECT_GE((found[i].point - found[j].point).norm(), 1.25e-3);
}

}  // namespace
}  // namespace insula
