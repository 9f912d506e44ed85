// SPDX-License-Identifier: GPL-3.0-or-later
// Detection and selection allocate nothing once they have their room: every operator new of this program counts.
#include <gtest/gtest.h>

#include "core/collision/colliders/contact_selection.h"
#include "core/collision/colliders/self_collider.h"
#include "core/collision/colliders/tissue_collider.h"
#include "core/collision/colliders/tool_collider.h"
#include "core/collision/shapes/shapes_for_test.h"
#include "core/testing/count_allocations.h"

namespace insula {
namespace {

TEST(Detection, AllocatesNothing) {
  TriMesh lower = shapes::sphere(Vec3(0, 0, -0.03), 0.03, 4), upper = shapes::sphere(Vec3(0, 0, 0.0303), 0.03, 4);
  CollisionMesh a, b;
  a.build(lower.vertices, lower.triangles);
  b.build(upper.vertices, upper.triangles);
  std::vector<Vec3> up(lower.vertices.size(), Vec3(0, 0, 0.0008)), down(upper.vertices.size(), Vec3(0, 0, -0.0005));
  ConvexPiece blade{"blade", {}, 0};
  for (int i = 0; i < 8; ++i) blade.points.push_back({i & 1 ? 2e-4 : -2e-4, i & 2 ? 2e-3 : -2e-3, i & 4 ? 0.01 : 0.0});
  ToolCollider tool({blade, {"rod", {Vec3(0, 0, 0.01), Vec3(0, 0, 0.05)}, 1e-3}}, a.triangle_count());
  TissueCollider tissue(sample_vertices(upper.vertices, upper.triangles, 2e-3), upper.vertices, a.triangle_count());
  std::vector<Proximity> found, faces;
  found.reserve(2048);
  faces.reserve(2048);
  ContactSelection of_tool, of_tissue;
  of_tool.reserve(2048, 8);
  of_tissue.reserve(2048, 8);
  std::uint64_t key = 0;
  long seen = 0;
  const long before = allocations;
  for (int i = 0; i < 200; ++i) {
    a.update(lower.vertices, up);
    b.update(upper.vertices, down);
    found.clear();
    faces.clear();
    const Pose start{Vec3(0.012 + 1e-4 * (i % 40), 0.001, 0.002 - 1e-4 * (i % 30)),
                     from_rotation_vector(Vec3(0, 1.2, 0))};
    const Pose free = displaced(start, (Vec6() << 1e-3, 5e-4, -4e-3, 0.01, 0.02, 0).finished());
    const Pose expected = displaced(start, (Vec6() << 1e-3, 5e-4, -1e-4, 0, 0, 0).finished());
    tool.detect(a, start, free, {.expected = i % 2 ? &expected : nullptr}, found);
    tissue.detect(b, a, {}, faces);
    of_tool.select(found, {}, key);
    of_tissue.select(faces, {.spacing = 4e-3, .advantage = 0, .max_contacts = 8, .max_per_piece = 8}, key);
    seen += long(found.size() + faces.size());
  }
  EXPECT_EQ(allocations - before, 0);
  EXPECT_GT(seen, 400);
}

TEST(Detection, OfAWallAgainstItselfAllocatesNothing) {
  const TriMesh rest = shapes::box(Vec3(-5e-3, -5e-3, -1e-3), Vec3(5e-3, 5e-3, 1e-3), 8);
  std::vector<Vec3> now = rest.vertices, free(now.size(), Vec3::Zero());
  CollisionMesh mesh;
  mesh.build(rest.vertices, rest.triangles);
  SelfCollider collider(rest.vertices, rest.triangles, 0.9e-3, 0.3e-3);
  std::vector<Proximity> found;
  found.reserve(2 * collider.samples().size());
  ContactSelection selection;
  selection.reserve(found.capacity(), 20);
  std::uint64_t key = 0;
  long seen = 0;
  SelfContactSettings settings;
  settings.outer = true;
  Workers workers(2);
  const long before = allocations;
  for (int i = 0; i < 100; ++i) {
    for (std::size_t v = 0; v < now.size(); ++v) now[v].z() = rest.vertices[v].z() * (1 - 0.01 * i);
    mesh.update(now, free);
    found.clear();
    collider.detect(mesh, settings, found, workers);
    seen += collider.opposite(mesh, 5, Vec3(0.3, 0.3, 0.4), -mesh.face_normal(5), 3e-3).triangle >= 0;
    selection.select(
        found, {.spacing = 1.2e-3, .advantage = 1e-4, .max_contacts = 20, .max_per_piece = 4, .both_ends = true}, key);
    seen += long(found.size());
  }
  EXPECT_EQ(allocations - before, 0);
  EXPECT_GT(seen, 400);
}

}  // namespace
}  // namespace insula
