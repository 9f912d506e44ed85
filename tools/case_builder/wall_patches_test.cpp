// SPDX-License-Identifier: GPL-3.0-or-later
// Painted parts of a wall: how they are read, what is refused, and what the built scene's membranes are there.
#include "tools/case_builder/wall_patches.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "core/base/input_error.h"
#include "core/mechanics/shell_body.h"
#include "core/registry/registry.h"
#include "core/sim/simulation.h"
#include "core/testing/block_mesh.h"
#include "tools/case_builder/intake.h"
#include "tools/case_builder/mirror.h"
#include "tools/case_builder/region_walls.h"
#include "tools/case_builder/scene_text.h"
#include "tools/case_builder/shapes_for_test.h"
#include "tools/case_builder/wall.h"

namespace insula::case_builder {
namespace {

std::string refusal(const std::string& text) {
  try {
    read_wall_patch(text);
  } catch (const InputError& e) {
    return e.what();
  }
  return "";
}

TEST(WallPatches, AreReadWithTheirUnits) {
  const WallPatch p = read_wall_patch("1 2 3 mm, 0.1 0 0 cm, radius=0.15 cm, young=7 MPa, thickness = 400 um");
  EXPECT_EQ(p.points, (std::vector<Point>{{1, 2, 3}, {1, 0, 0}}));
  EXPECT_NEAR(p.radius_mm, 1.5, 1e-12);
  EXPECT_EQ(p.young, "7 MPa");
  EXPECT_EQ(p.thickness, "400 um");
  EXPECT_EQ(read_wall_patch("1 2 3 mm, young=7 MPa").radius_mm, 1);
}

TEST(WallPatches, WrongOnesAreRefusedInWords) {
  EXPECT_NE(refusal("1 2 3 mm, young=7").find("MPa"), std::string::npos) << refusal("1 2 3 mm, young=7");
  EXPECT_NE(refusal("1 2 3 mm, thickness=2 cm").find("outside the allowed range"), std::string::npos);
  EXPECT_NE(refusal("1 2 3 mm, radius=9 cm, young=7 MPa").find("radius: "), std::string::npos);
  EXPECT_NE(refusal("1 2 3, young=7 MPa").find("has no unit; write \"1 2 3 mm\""), std::string::npos)
      << refusal("1 2 3, young=7 MPa");
  EXPECT_NE(refusal("1 2 3 mm").find("changes neither thickness nor young"), std::string::npos);
  EXPECT_NE(refusal("young=7 MPa").find("it has no point"), std::string::npos);
  EXPECT_NE(refusal("1 2 3 mm, poisson=0.4").find("it has radius, thickness and young"), std::string::npos);
}

TEST(WallPatches, ComeBackFromCaseNotes) {
  Options o;
  o.wall_patches = {read_wall_patch("1 2 3 mm, young=7 MPa"), read_wall_patch("4 5 6 mm, 7 8 9 mm, thickness=1 mm")};
  const Options again = options_from_json(to_json(o));
  ASSERT_EQ(again.wall_patches.size(), 2u);
  EXPECT_EQ(again.wall_patches[0].young, "7 MPa");
  EXPECT_EQ(again.wall_patches[0].thickness, "");
  EXPECT_EQ(again.wall_patches[1].points, o.wall_patches[1].points);
  o.mirror = true;
  EXPECT_EQ(as_read(o).wall_patches[1].points[1][0], -7);
  EXPECT_FALSE(to_json(Options()).contains("wall_patches")) << "cases of before stay as they are";
}

class PatchedTube : public testing::Test {
 protected:
  PatchedTube() {
    Options o;
    o.vertices = 900;
    vessel_ = make_wall(mended(test::tube_with_sac(), "tube", o, {}).surface, o, notes_, quiet_);
    const auto& x = vessel_.wall.mesh.vertices;
    top_ = *std::max_element(x.begin(), x.end(), [](const Vec3& a, const Vec3& b) { return a.z() < b.z(); });
  }
  std::vector<PatchOf> patches(std::vector<WallPatch> painted) {
    Options o;
    o.wall_patches = std::move(painted);
    return patches_of(vessel_, o, notes_);
  }
  WallPatch at(const Vec3& p) const { return {{{p.x(), p.y(), p.z()}}, 1, "0.4 mm", "7 MPa"}; }

  Progress quiet_;
  std::vector<Note> notes_;
  artery::Vessel vessel_;
  Vec3 top_;
};

TEST_F(PatchedTube, PointsOffTheWallAreLeftOutAndToldOf) {
  notes_.clear();
  WallPatch half = at(top_);
  half.points.push_back({0, 0, 40});
  const std::vector<PatchOf> out = patches({half, at(Vec3(0, 0, 40))});
  ASSERT_EQ(out.size(), 1u);
  EXPECT_EQ(out[0].spots.size(), 1u);
  ASSERT_EQ(notes_.size(), 2u);
  EXPECT_EQ(notes_[0].id, "patch_off_wall");
  EXPECT_NE(notes_[0].text.find("1 of its 2 points"), std::string::npos) << notes_[0].text;
}

TEST_F(PatchedTube, WhatIsNotGivenIsThatOfTheRegion) {
  WallPatch thin = at(top_);
  thin.young.clear();
  const std::vector<WallOf> walls = walls_of(vessel_, {});
  const auto bleb = std::find_if(walls.begin(), walls.end(), [](const WallOf& w) { return w.regions == "bleb"; });
  ASSERT_NE(bleb, walls.end());
  EXPECT_EQ(patches({thin})[0].young_mpa, bleb->young_mpa);
  EXPECT_EQ(patches({thin})[0].thickness_mm, 0.4);
}

/// Thickness that a triangle of the built wall is to have, m.
double expected_thickness(const ShellBody& body, const std::array<int, 3>& t, const std::vector<WallOf>& walls,
                          const PatchOf& patch) {
  Vec3 middle = Vec3::Zero();
  for (const int v : t) middle += 1000 * body.rest_nodes()[std::size_t(v)] / 3;
  if ((middle - patch.spots[0]).norm() <= patch.radius_mm) return 1e-3 * patch.thickness_mm;
  const std::string& region = body.model().regions[std::size_t(body.region_of_triangle(t))];
  for (const WallOf& w : walls)
    if ((" " + w.regions + " ").find(" " + region + " ") != std::string::npos) return 1e-3 * w.thickness_mm;
  return 0;
}

TEST_F(PatchedTube, TheBuiltScenesMembraneHasTheValuesThere) {
  insula::test::SceneFolder folder;
  SceneFacts f;
  f.name = "tube", f.walls = walls_of(vessel_, {}), f.patches = patches({at(top_)}), f.tethered = "parent";
  f.patches[0].spots[0] = (top_ * 100).array().round() / 100;  // as the scene has it
  artery::write_vessel(vessel_, folder.path() / "artery");
  folder.write("artery.xml", artery_part(f));
  folder.write("scene.xml", "<scene><include file=\"artery.xml\"/></scene>");
  Registry registry;
  register_builtin(registry);
  const SimulationResult loaded = load_simulation(folder.path() / "scene.xml", registry, 1);
  ASSERT_TRUE(loaded.simulation) << loaded.diagnostics.format();
  const ShellBody* body = nullptr;
  for (const Body* b : loaded.simulation->bodies())
    if (b->id == "artery") body = dynamic_cast<const ShellBody*>(b);
  ASSERT_TRUE(body);
  std::vector<double> mass(std::size_t(body->nodes()), 0.0);
  int painted = 0;
  for (const auto& t : body->wall_triangles()) {
    const auto at = [&](std::size_t k) { return body->rest_nodes()[std::size_t(t[k])]; };
    const double area = 0.5 * (at(1) - at(0)).cross(at(2) - at(0)).norm(),
                 thickness = expected_thickness(*body, t, f.walls, f.patches[0]);
    painted += thickness == 4e-4;
    for (const int v : t) mass[std::size_t(v)] += (1100 * thickness + 1) * area / 3;  // density, added mass
  }
  EXPECT_GT(painted, 5);
  for (std::size_t v = 0; v < mass.size(); ++v) EXPECT_NEAR(body->node_mass()[v], mass[v], 1e-9 * mass[v]) << v;
  const Component* patch = nullptr;
  for (const auto& child : body->children)
    if (child->id == "wall_patch_1") patch = child.get();
  ASSERT_TRUE(patch);
  EXPECT_DOUBLE_EQ((*dynamic_cast<const QuantityParam*>(patch->find_param("young")))(), 7e6);
  EXPECT_DOUBLE_EQ((*dynamic_cast<const QuantityParam*>(patch->find_param("thickness")))(), 4e-4);
}

}  // namespace
}  // namespace insula::case_builder
