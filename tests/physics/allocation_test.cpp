// SPDX-License-Identifier: GPL-3.0-or-later
// What allocates: nothing in solve, nothing in the parts of a step. Every operator new of this program counts. Whole
// steps of every plugin: contracts_test.cpp.
#include <gtest/gtest.h>

#include "core/collision/colliders/contact_selection.h"
#include "core/collision/colliders/vertex_collider.h"
#include "core/collision/shapes/shapes_for_test.h"
#include "core/linalg/kernels.h"
#include "core/testing/count_allocations.h"
#include "core/testing/example.h"
#include "engine/reports/report_writer.h"
#include "tests/physics/random_problem.h"

namespace insula {
namespace {

const std::filesystem::path plugins = std::filesystem::path(INSULA_SOURCE_DIR) / "plugins";

TEST(Allocation, TheCounterCounts) {
  const long before = allocations;
  { std::vector<double> v(10); }
  EXPECT_GT(allocations - before, 0);
}

TEST(Allocation, SolveAllocatesNothing) {
  auto s = test::load(plugins / "strand_springs" / "example.xml");
  ASSERT_TRUE(s);
  test::run_script(*s, 30);
  const ConstraintProblem p = s->problem();
  ASSERT_GT(p.rows, 5);
  SolveWorkspace ws;
  ws.reserve(p.rows);
  ws.lambda.assign(std::size_t(p.rows), 0.0);
  solve(p, p.delta_free, {1, 1e-9}, ws);  // the first call picks the processor's kernels
  ws.lambda.assign(std::size_t(p.rows), 0.0);
  SolveWorkspace fresh;
  fresh.reserve(p.rows);
  fresh.lambda.assign(std::size_t(p.rows), 0.0);
  const long before = allocations;
  solve(p, p.delta_free, {200, 1e-9}, ws);
  solve(p, p.delta_free, {200, 1e-9}, fresh);
  EXPECT_EQ(allocations - before, 0);
}

// What a session's report is made from is gathered between the steps of people who play for hours.
TEST(Allocation, RecordingAStepAllocatesNothing) {
  auto s = test::load(plugins / "clip" / "example.xml", 2);
  ASSERT_TRUE(s);
  RunRecorder recorder(1000);
  test::run_script(*s, 70);
  recorder.record(s->report(), {}, {0.1, 0.2}, s->energy());
  const long before = allocations;
  for (int i = 0; i < 5000; ++i) recorder.record(s->report(), {}, {0.1, 0.2}, s->energy());
  EXPECT_EQ(allocations - before, 0);
  EXPECT_EQ(recorder.steps(), 5001);
}

// A problem of jaws, contacts with friction among them, however many sweeps and directions it takes.
TEST(Allocation, SolveOfAHardProblemAllocatesNothing) {
  ConstraintProblem p;
  const int contacts = 13;
  p.resize(3 * contacts);
  for (int k = 0; k < contacts; ++k) {
    Block b;
    b.id = std::uint64_t(k);
    b.row = 3 * k;
    b.law = LawKind::friction;
    b.friction = 0.4;
    p.blocks.push_back(b);
    for (int r = 3 * k; r < 3 * k + 3; ++r) {
      p.w[std::size_t(r * p.stride + r)] = k == 0 || k == contacts - 1 ? 1.01 : 2;
      if (k > 0) p.w[std::size_t(r * p.stride + r - 3)] = -1;
      if (k + 1 < contacts) p.w[std::size_t(r * p.stride + r + 3)] = -1;
    }
    p.delta_free[std::size_t(3 * k)] = k == 0 || k == contacts - 1 ? -0.02 : 0;
    p.delta_free[std::size_t(3 * k + 1)] = k == 0 || k == contacts - 1 ? 0.004 : 0;
  }
  SolveWorkspace ws;
  ws.reserve(p.rows);
  ws.lambda.assign(std::size_t(p.rows), 0.0);
  kernels();
  const long before = allocations;
  const SolveStats stats = solve(p, p.delta_free, {3000, 1e-11, true}, ws);
  EXPECT_EQ(allocations - before, 0);
  EXPECT_GT(stats.sweeps, 10);
}

// Contacts that share friction forces, with and without conjugate directions; a step of a scene with them.
TEST(Allocation, SolveOfPatchesAllocatesNothing) {
  Random random(17);
  int patches = 0;
  for (int trial = 0; trial < 200; ++trial) {
    const ConstraintProblem p = test::random_problem(random, 0.5);
    SolveWorkspace ws;
    ws.reserve(p.rows);
    ws.lambda.assign(std::size_t(p.rows), 0.0);
    const long before = allocations;
    solve(p, p.delta_free, {50, 1e-11, trial % 2 == 0}, ws);
    EXPECT_EQ(allocations - before, 0);
    for (const Block& b : p.blocks) patches += b.law == LawKind::patch;
  }
  EXPECT_GT(patches, 100);
}

TEST(Allocation, DetectionByVerticesAllocatesNothing) {
  const TriMesh rest = shapes::sphere(Vec3::Zero(), 3e-3, 4);
  std::vector<Vec3> now = rest.vertices, free(now.size(), Vec3(0, 0, 2e-4));
  CollisionMesh mesh;
  mesh.build(rest.vertices, rest.triangles);
  ConvexPiece jaw{"jaw", {}, 0};
  for (int i = 0; i < 8; ++i) jaw.points.push_back({i & 1 ? 3e-3 : -3e-3, i & 2 ? 1e-3 : -1e-3, i & 4 ? 5e-4 : -5e-4});
  VertexCollider collider({jaw, {"rod", {Vec3(0, 0, 5e-4), Vec3(0, 0, 0.02)}, 1e-3}}, rest.triangles, rest.vertices);
  std::vector<Proximity> found;
  found.reserve(2 * now.size());
  ContactSelection selection;
  selection.reserve(found.capacity(), 100);
  std::uint64_t key = 0;
  long seen = 0;
  const long before = allocations;
  for (int i = 0; i < 60; ++i) {
    mesh.update(now, free);
    found.clear();
    const Pose start{Vec3(1e-4 * (i % 10), 0, 5e-3 - 5e-5 * i), from_rotation_vector(Vec3(0.01 * i, 0, 0))};
    collider.detect(mesh, start, displaced(start, (Vec6() << 0, 0, -1e-3, 0.05, 0, 0).finished()),
                    {.alarm = 3e-4, .offset = 1.5e-4}, found);
    selection.select(found, {.spacing = 0, .advantage = 1e-4, .max_contacts = 100, .max_per_piece = 100}, key);
    seen += long(found.size());
  }
  EXPECT_EQ(allocations - before, 0);
  EXPECT_GT(seen, 400);
}

}  // namespace
}  // namespace insula
