// SPDX-License-Identifier: GPL-3.0-or-later
// Surface patches in the haptic problem's wire format.
#include <functional>

#include "core/haptics/haptic_update_for_test.h"

namespace insula {
namespace {

using testing::Buffer;
using testing::encoded;
using testing::make_update;

/// Rows: a spring, a contact with friction (1 to 3), two vertices (4 to 9), springs. A third vertex cannot move.
constexpr int contact_row = 1, vertex_row = 4;

HapticUpdate patched_update(unsigned seed) {
  HapticUpdate u = make_update(seed, 9, 1, 2);
  ConstraintProblem& p = u.problem;
  for (Block& b : p.blocks) {
    b.role = BlockRole::other;
    if (b.row < vertex_row || b.row >= vertex_row + 6) continue;
    b.role = BlockRole::surface;
    b.lower = b.upper = b.compliance = 0;
    p.lambda[std::size_t(b.row)] = 0;
  }
  SurfacePatches& s = p.patches;
  s.vertices = {
      {vertex_row, Vec3(0.01, 0.02, 0.03)}, {vertex_row + 3, Vec3(0.02, 0.02, 0.03)}, {-1, Vec3(0.01, 0.03, 0)}};
  s.vertices[0].weighted_normal = Vec3(0, 0, 1);
  s.vertices[1].weighted_normal = Vec3(0.3, 0.2, 0.1);
  s.triangles = {{{0, 1, 2}, 5}, {{0, 2, 1}, 0}};
  s.core = {Vec3(0, 0, 0.001), Vec3(0, 0, 0.011), Vec3(0, 0.002, 0)};
  PatchPiece shaft;
  shaft.index = 3;
  shaft.first_core = 0;
  shaft.cores = 2;
  shaft.radius = 1.5e-3;
  shaft.axis0 = s.core[0];
  shaft.axis1 = s.core[1];
  PatchPiece ball;
  ball.first_core = 2;
  ball.cores = 1;
  ball.radius = 0.5e-3;
  ball.bound = 0.1e-3;
  s.pieces = {shaft, ball};
  s.replaced = {{contact_row, 3, 1, Vec3(0.25, 0.5, 0.25)}};
  SurfacePatch patch;
  patch.id = 12345;
  patch.tool = 1;
  patch.curved = 1;
  patch.friction = 0.2;
  patch.compliance_m_per_N = 1e-3;
  patch.alarm_m = 1e-3;
  patch.spacing_m = 2e-3;
  patch.half_thickness_m = 0.1e-3;
  patch.max_correction_m = 0.5e-3;
  patch.max_contacts = 8;
  patch.max_per_piece = 4;
  patch.triangles = patch.pieces = 2;
  patch.replaced = 1;
  s.patches = {patch};
  return u;
}

TEST(SurfacePatchWire, RoundTripIsExactAndInTheFormOfTheGeneratedClass) {
  const HapticUpdate sent = patched_update(3);
  const Buffer bytes = encoded(sent);
  HapticUpdate got = make_update(9);
  std::string why;
  ASSERT_TRUE(decode_problem(bytes, got, why)) << why;
  testing::expect_equal(sent, got);
  EXPECT_TRUE(sent.problem.patches == got.problem.patches);
  const auto message = testing::expect_generated_form(bytes);
  EXPECT_EQ(message.patch_vertex[1].row, vertex_row + 3);
  EXPECT_EQ(message.patch_triangle[0].open, 5);
  EXPECT_EQ(message.patch_piece[0].index, 3);
  EXPECT_EQ(message.patch[0].id, 12345);
}

TEST(SurfacePatchWire, AToolThatIsLeftOutTakesItsPatchesWithIt) {
  const HapticUpdate sent = patched_update(3);  // tool 0 is in hand 1, tool 1 in hand 0
  for (const int hand : {0, 1}) {
    Buffer bytes;
    ASSERT_TRUE(encode_problem(sent, sent.problem, {hand == 0, hand == 1}, bytes));
    HapticUpdate got = make_update(9);
    std::string why;
    ASSERT_TRUE(decode_problem(bytes, got, why)) << why;
    ASSERT_EQ(got.problem.patches.patches.size(), hand == 0 ? 0u : 1u);
    if (hand == 1) {
      EXPECT_EQ(got.problem.patches.patches[0].tool, 0);
    }
  }
}

TEST(SurfacePatchWire, WhatRefersToNothingOrIsOutOfRangeIsRefused) {
  using Patches = SurfacePatches;
  const std::vector<std::pair<const char*, std::function<void(Patches&)>>> faults = {
      {"vertex of a spring", [](Patches& s) { s.vertices[1].row = 8; }},
      {"vertex of a contact", [](Patches& s) { s.vertices[1].row = contact_row; }},
      {"vertex without rows", [](Patches& s) { s.vertices[1].row = 11; }},
      {"negative row", [](Patches& s) { s.vertices[1].row = -2; }},
      {"vertex far away", [](Patches& s) { s.vertices[0].position.x() = 1e3; }},
      {"vertex that is no number", [](Patches& s) { s.vertices[0].position.x() = NAN; }},
      {"normal that is too long", [](Patches& s) { s.vertices[0].weighted_normal.x() = 0.1; }},
      {"normal that is no number", [](Patches& s) { s.vertices[0].weighted_normal.x() = NAN; }},
      {"corner that is not there", [](Patches& s) { s.triangles[0].corner[2] = 3; }},
      {"negative corner", [](Patches& s) { s.triangles[0].corner[2] = -1; }},
      {"the same corner twice", [](Patches& s) { s.triangles[0].corner[2] = 0; }},
      {"a fourth edge", [](Patches& s) { s.triangles[0].open = 8; }},
      {"core that is no number", [](Patches& s) { s.core[0].z() = INFINITY; }},
      {"core beyond the last", [](Patches& s) { s.pieces[1].cores = 2; }},
      {"piece without a core", [](Patches& s) { s.pieces[1].cores = 0; }},
      {"negative radius", [](Patches& s) { s.pieces[1].radius = -1e-3; }},
      {"radius that is no number", [](Patches& s) { s.pieces[1].radius = NAN; }},
      {"contact that is a spring", [](Patches& s) { s.replaced[0].row = 0; }},
      {"contact beyond the rows", [](Patches& s) { s.replaced[0].row = 11; }},
      {"contact of no piece", [](Patches& s) { s.replaced[0].piece = -1; }},
      {"contact on no triangle", [](Patches& s) { s.replaced[0].triangle = 2; }},
      {"contact outside its triangle", [](Patches& s) { s.replaced[0].bary = Vec3(2, -1, 0); }},
      {"tool that is not there", [](Patches& s) { s.patches[0].tool = 7; }},
      {"friction", [](Patches& s) { s.patches[0].friction = 11; }},
      {"no friction", [](Patches& s) { s.patches[0].friction = 0; }},
      {"neither flat nor curved", [](Patches& s) { s.patches[0].curved = 2; }},
      {"compliance", [](Patches& s) { s.patches[0].compliance_m_per_N = -1; }},
      {"alarm", [](Patches& s) { s.patches[0].alarm_m = 0; }},
      {"spacing", [](Patches& s) { s.patches[0].spacing_m = 1; }},
      {"correction", [](Patches& s) { s.patches[0].max_correction_m = NAN; }},
      {"no contacts", [](Patches& s) { s.patches[0].max_contacts = 0; }},
      {"triangles beyond the last", [](Patches& s) { s.patches[0].triangles = 3; }},
      {"pieces before the first", [](Patches& s) { s.patches[0].first_piece = -1; }},
      {"contacts beyond the last", [](Patches& s) { s.patches[0].replaced = 2; }},
      {"the same id twice", [](Patches& s) { s.patches.push_back(s.patches[0]); }},
  };
  const HapticUpdate before = make_update(9);
  for (const auto& [name, fault] : faults) {
    HapticUpdate u = patched_update(4), into = before;
    fault(u.problem.patches);
    Buffer bytes;
    std::string why;
    ASSERT_TRUE(encode_problem(u, u.problem, {}, bytes)) << name;
    // A tool that does not exist is not sent at all.
    if (std::string_view(name) == "tool that is not there") {
      EXPECT_TRUE(decode_problem(bytes, into, why) && into.problem.patches.empty());
      continue;
    }
    EXPECT_FALSE(decode_problem(bytes, into, why)) << name;
    EXPECT_NE(why.find("surface patch"), std::string::npos) << name << ": " << why;
    testing::expect_equal(before, into);
  }
}

TEST(SurfacePatchWire, EveryTruncationAndRandomDamageIsRefusedOrWhole) {
  const Buffer whole = encoded(patched_update(1));
  testing::damage_message(
      whole, 78, 50'000,
      [](bool accepted, const Buffer& damaged, const Buffer& before, const Buffer& now, const HapticUpdate& into) {
        ASSERT_EQ(now, accepted ? damaged : before);
        const SurfacePatches& s = into.problem.patches;
        for (const PatchVertex& v : s.vertices) ASSERT_TRUE(v.row >= -1 && v.row + 3 <= into.problem.rows);
        for (const PatchTriangle& t : s.triangles)
          for (const int v : t.corner) ASSERT_TRUE(v >= 0 && std::size_t(v) < s.vertices.size());
        for (const SurfacePatch& p : s.patches) ASSERT_LT(p.tool, int(into.problem.tools.size()));
      });
}

}  // namespace
}  // namespace insula
