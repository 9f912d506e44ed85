// SPDX-License-Identifier: GPL-3.0-or-later
// Blades on the surface of a bulky body: what wraps about a blade's edge goes back to the blade's front.
#include <gtest/gtest.h>

#include "core/collision/colliders/sheet_for_test.h"
#include "core/collision/colliders/vertex_collider.h"
#include "core/testing/held.h"

namespace insula {
namespace {

constexpr double half_x = 1.5e-3, half_y = 1e-3, half_z = 0.5e-3;  // of a blade
constexpr double lip = 0.2e-3;  // what a vertex is above the blade's back, or below its front

/// A row of vertices under a blade that stays where it is; one of them goes where it is sent.
struct Row {
  std::vector<Vec3> rest, now;
  std::vector<std::array<int, 3>> triangles;
  CollisionMesh mesh;
  VertexCollider collider;
  bool one_sided;
  static constexpr int n = 13, sent = n / 2;

  static std::vector<ConvexPiece> blade() { return {test::box_piece(half_x, half_y, half_z)}; }
  static std::vector<std::array<int, 3>> strip() {
    std::vector<std::array<int, 3>> t;
    for (int i = 0; i + 1 < n; ++i) t.push_back({i, i + 1, n + i});
    return t;
  }
  // Under the blade, along x; the second row of the triangles lies far away.
  static std::vector<Vec3> rows() {
    std::vector<Vec3> x;
    for (int i = 0; i < n; ++i) x.push_back({0.2e-3 * (i - sent), 0, -half_z - 0.01e-3});
    for (int i = 0; i < n; ++i) x.push_back({0.2e-3 * (i - sent), 50e-3, -half_z});
    return x;
  }
  explicit Row(bool one)
      : rest(rows()), now(rest), triangles(strip()), collider(blade(), triangles, rest), one_sided(one) {
    mesh.build(rest, triangles);
  }
  std::vector<Proximity> detect() {
    std::vector<Proximity> out;
    mesh.update(now, {});
    ToolContactSettings s;
    s.alarm = 0.3e-3;
    s.one_sided = one_sided;
    collider.detect(mesh, Pose{}, Pose{}, s, out);
    return out;
  }
  void press(int steps) {
    for (int i = 0; i < steps; ++i) detect();
  }
  void all_to(const Vec3& place) {
    for (int i = 0; i < n; ++i) now[std::size_t(i)] = place;
  }
  Proximity of_sent() {
    for (const Proximity& c : detect())
      if (c.vertex == sent) return c;
    return {};
  }
  /// From under the blade round its edge at +y to its back; the contact there.
  Proximity go_round() {
    Vec3& x = now[std::size_t(sent)];
    const double out = half_y + lip, up = half_z + lip;
    x = Vec3(0, 0, -up);
    const auto to = [&](const Vec3& target) {
      const Vec3 from = x;
      for (int k = 1; k <= 40; ++k) {
        x = from + k / 40.0 * (target - from);
        detect();
      }
    };
    to({0, half_y, -up});
    to({0, out, -half_z});
    to({0, out, half_z});
    to({0, half_y, up});
    to({0, 0, up});
    return of_sent();
  }
};

TEST(OneSided, AVertexThatCameRoundTheEdgeGoesBackToTheFront) {
  for (const bool one_sided : {true, false}) {
    Row row(one_sided);
    row.press(60);
    const Proximity c = row.go_round();
    ASSERT_EQ(c.vertex, Row::sent) << one_sided;
    if (one_sided) {
      // Through the whole blade to the place under it: its thickness and what it is above it.
      EXPECT_LT((c.normal.normalized() - Vec3::UnitZ()).norm(), 1e-9) << c.normal.transpose();
      EXPECT_TRUE(test::held("normal at a retractor's edge", std::abs(c.normal.norm() - 1), 1, 1e-12))
          << "rows count the force by it";
      EXPECT_LT(c.gap, -lip);
      EXPECT_GE(c.start_gap, -1e-3 - 1e-15) << "more than max_correction";
    } else {
      EXPECT_LT((c.normal + Vec3::UnitZ()).norm(), 1e-9);
      EXPECT_NEAR(c.gap, lip, 1e-9);
    }
  }
}

// Before a blade has come to a body it has no side: what is on its back belongs there.
TEST(OneSided, ABladeThatPressedNothingHasNoSide) {
  Row row(true);
  row.all_to({0, 20e-3, 0});
  row.press(60);
  row.now[std::size_t(Row::sent)] = Vec3(0, 0, half_z + lip);
  const Proximity c = row.of_sent();
  ASSERT_EQ(c.vertex, Row::sent);
  EXPECT_LT((c.normal + Vec3::UnitZ()).norm(), 1e-9);
  EXPECT_NEAR(c.gap, lip, 1e-9);
}

// The side is learned as the blade comes to the body. Pressed for long at its edge later, it is still the same.
TEST(OneSided, TheSideIsLearnedOnce) {
  Row row(true);
  row.press(60);
  ASSERT_LT((row.go_round().normal.normalized() - Vec3::UnitZ()).norm(), 1e-9);
  row.all_to({0, 20e-3, 0});
  row.press(1);
  row.all_to({0, half_y + 0.01e-3, 0});
  row.press(200);
  row.all_to({0, 20e-3, 0});
  row.press(1);
  EXPECT_LT((row.go_round().normal.normalized() - Vec3::UnitZ()).norm(), 1e-9);
  // A reset forgets it.
  row.collider.reset();
  row.all_to({0, 20e-3, 0});
  row.now[std::size_t(Row::sent)] = Vec3(0, 0, half_z + lip);
  EXPECT_LT((row.of_sent().normal + Vec3::UnitZ()).norm(), 1e-9);
}

}  // namespace
}  // namespace insula
