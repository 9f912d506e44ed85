// SPDX-License-Identifier: GPL-3.0-or-later
// Loops of a grid are parted at their thinnest place, and nothing else changes.
#include "tools/case_builder/handles.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "core/testing/example.h"
#include "tools/artery/generated_artery_for_test.h"
#include "tools/case_builder/intake.h"
#include "tools/case_builder/shapes_for_test.h"

namespace insula::case_builder {
namespace {

mesh_tool::Field sampled(const mesh_tool::Grid& grid, const std::function<double(const Vec3&)>& depth) {
  mesh_tool::Field out;
  for (int k = 0; k < grid.size[2]; ++k)
    for (int j = 0; j < grid.size[1]; ++j)
      for (int i = 0; i < grid.size[0]; ++i) {
        const auto p = grid.point(i, j, k);
        out.push_back(float(depth(Vec3(p[0], p[1], p[2]))));
      }
  return out;
}

int euler_number(const mesh_tool::Grid& grid, const mesh_tool::Field& inside) {
  artery::NodeValues nodes{Vec3(grid.origin[0], grid.origin[1], grid.origin[2]), grid.spacing, grid.size, {}};
  for (const float v : inside) nodes.value.push_back(-v);
  return artery::quality(artery::extract(std::move(nodes))).euler;
}

/// A ring about the z axis that is thinnest at +x.
double depth_in_ring(const Vec3& p) {
  const double thin = 1.4 - 0.5 * std::exp(-(p - Vec3(5, 0, 0)).squaredNorm());
  return thin - std::hypot(std::hypot(p.x(), p.y()) - 5, p.z());
}

TEST(Handles, ARingIsPartedWhereItIsThinnest) {
  const mesh_tool::Grid grid{{60, 60, 20}, {-7.9, -7.8, -2.6}, 0.27};
  mesh_tool::Field inside = sampled(grid, depth_in_ring);
  const mesh_tool::Field before = inside;
  ASSERT_EQ(euler_number(grid, inside), 0);
  const PartedHandles parted = part_handles(grid, inside);
  EXPECT_EQ(euler_number(grid, inside), 2);
  EXPECT_GT(parted.nodes, 5);
  EXPECT_LT((parted.first - Vec3(5, 0, 0)).norm(), 1.6);
  for (std::size_t i = 0; i < inside.size(); ++i)
    if (inside[i] != before[i]) {
      EXPECT_GT(before[i], 0);
      EXPECT_LT(inside[i], 0);
      const auto p = grid.point(int(i % 60), int(i / 60 % 60), int(i / 3600));
      EXPECT_LT((Vec3(p[0], p[1], p[2]) - Vec3(5, 0, 0)).norm(), 1.6);
    }
}

TEST(Handles, ABallStaysAsItIs) {
  const mesh_tool::Grid grid{{30, 30, 30}, {-4.1, -4.2, -4.3}, 0.3};
  mesh_tool::Field inside = sampled(grid, [](const Vec3& p) { return 3 - p.norm(); });
  const mesh_tool::Field before = inside;
  EXPECT_EQ(part_handles(grid, inside).nodes, 0);
  EXPECT_EQ(inside, before);
}

class TakenIn : public testing::Test {
 protected:
  insula::test::SceneFolder folder;
  Progress quiet;
  Intake take(const TriMesh& mesh) {
    folder.write("vessel.stl", test::stl_text(mesh));
    return take_in(folder.path() / "vessel.stl", {}, quiet);
  }
  static bool told(const Intake& in, const std::string& part) {
    return std::any_of(in.notes.begin(), in.notes.end(),
                       [&](const Note& n) { return n.text.find(part) != std::string::npos; });
  }
};

TEST_F(TakenIn, ABranchThatTouchesTheDomeIsPartedFromIt) {
  using namespace artery::test;
  GeneratedArtery touching = kissing(on_fork("touching", {}, Dome(), 0, 0), 0.3);
  touching.step = 0.25;
  const TriMesh given = touching.surface().mesh;
  ASSERT_EQ(artery::quality(given).euler, 0);
  const Intake in = take(given);
  EXPECT_TRUE(told(in, "grown together"));
  EXPECT_EQ(in.surface.caps.size(), 3u);
  EXPECT_EQ(artery::quality(in.surface.mesh).euler, 2);
}

TEST_F(TakenIn, ANoisySurfaceWithOpenEndsIsMadeAnew) {
  const artery::Surface smooth = artery::test::generated_arteries().front().surface();
  std::mt19937 random(5);
  std::normal_distribution<double> noise(0, 0.06);  // mm
  TriMesh open = smooth.mesh;
  open.triangles.clear();
  for (std::size_t t = 0; t < smooth.patch.size(); ++t)
    if (smooth.patch[t] < 0) open.triangles.push_back(smooth.mesh.triangles[t]);
  for (Vec3& p : open.vertices)
    for (int a = 0; a < 3; ++a) p[a] += noise(random);
  const Intake in = take(open);
  EXPECT_TRUE(told(in, "ran through itself"));
  EXPECT_EQ(in.surface.caps.size(), 3u);
  EXPECT_FALSE(artery::quality(in.surface.mesh).self_intersecting);
}

}  // namespace
}  // namespace insula::case_builder
