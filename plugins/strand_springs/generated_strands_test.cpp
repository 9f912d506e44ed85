// SPDX-License-Identifier: GPL-3.0-or-later
// Strands that the plugin itself puts between surfaces.
#include <gtest/gtest.h>

#include <set>

#include "core/testing/block_mesh.h"
#include "core/testing/example.h"
#include "plugins/strand_springs/strand_springs.h"

namespace insula {
namespace {

TEST(StrandSprings, GeneratedAcrossTheGap) {
  const auto example = std::filesystem::path(INSULA_SOURCE_DIR) / "plugins/strand_springs/example.xml";
  auto one = test::load(example), two = test::load(example);
  ASSERT_TRUE(one && two);
  auto* strands = one->scene().find_as<StrandSprings>("strands");
  one->step();
  two->step();
  const auto a_ends = Strands(*one).now();
  const auto b_ends = Strands(*two).now();
  ASSERT_EQ(a_ends.size(), b_ends.size());
  EXPECT_LE(strands->count(), 32);  // 8 per cm2 on 4 cm2, doubles left out
  EXPECT_GE(strands->count(), 14);
  std::set<std::pair<double, double>> starts;
  for (std::size_t i = 0; i < a_ends.size(); ++i) {
    EXPECT_EQ(a_ends[i].a, b_ends[i].a);
    EXPECT_EQ(a_ends[i].b, b_ends[i].b);
    EXPECT_LE((a_ends[i].a - a_ends[i].b).norm(), 0.0062);
    EXPECT_LT(a_ends[i].a.z(), 0.0005);
    EXPECT_GT(a_ends[i].b.z(), 0.0015);
    starts.insert({a_ends[i].a.x(), a_ends[i].a.y()});
  }
  EXPECT_GT(starts.size(), 8u) << "strands bunch up";
}

/// A trough of a soft body, 6 mm wide: walls of 2 mm, a floor of 1 mm, a gap of 2 mm, 9 mm deep; or only one wall and
/// the floor.
std::unique_ptr<Simulation> trough(test::SceneFolder& folder, bool two_walls, const std::string& attributes) {
  TetMesh block = test::block_mesh({3, 4, 10}, Vec3(0, 0, 0), Vec3(0.006, 0.004, 0.01));
  std::vector<std::array<int, 4>> kept;
  for (const auto& t : block.tets) {
    Vec3 middle = Vec3::Zero();
    for (int n : t) middle += 0.25 * block.nodes[std::size_t(n)];
    if (middle.z() < 0.001 || middle.x() < 0.002 || (two_walls && middle.x() > 0.004)) kept.push_back(t);
  }
  block.tets = kept;
  folder.write("meshes/trough.msh", test::gmsh_text(block));
  SimulationResult loaded = load_simulation_text(R"(<scene>
  <solver tolerance="1e-15 m" max_sweeps="10000"/>
  <soft_body id="trough" mesh="meshes/trough.msh" mesh_unit="m"><corotational_fem/>
    <fixed region="beyond" centre="0 0 0.0005 m" normal="0 0 -1"/><surface id="skin"/></soft_body>
  <strand_springs id="strands" from="skin" to="skin" max_length="2.6 mm" density="60 1/cm2" seed="3" )" +
                                                     attributes + "/></scene>",
                                                 folder.path() / "trough.xml", test::builtin());
  if (!loaded.simulation) {
    EXPECT_NE(loaded.diagnostics.format().find("no strand fits"), std::string::npos) << loaded.diagnostics.format();
  }
  return std::move(loaded.simulation);
}

// Across the gap, but not down in the corner, where the path along the floor is hardly longer than the strand.
TEST(StrandSprings, OneSurfaceIsTiedToItselfAcrossAGap) {
  test::SceneFolder folder;
  const auto s = trough(folder, true, "");
  ASSERT_TRUE(s);
  s->step();
  const auto strands = Strands(*s).now();
  EXPECT_GE(strands.size(), 8u);
  using Place = std::array<double, 3>;
  std::set<std::pair<Place, Place>> pairs;
  for (const StrandState& t : strands) {
    EXPECT_NEAR(std::abs(t.a.x() - t.b.x()), 0.002, 1e-4) << "not across the gap";
    EXPECT_GT(t.a.z() + t.b.z(), 0.006 - 1e-4) << "2 (z - 1 mm) + 2 mm must be more than three times 2 mm";
    const Place here{t.a.x(), t.a.y(), t.a.z()}, there{t.b.x(), t.b.y(), t.b.z()};
    pairs.insert({std::min(here, there), std::max(here, there)});
  }
  EXPECT_EQ(pairs.size(), strands.size()) << "a strand and its reverse are one";
  EXPECT_FALSE(trough(folder, false, "")) << "nothing faces anything across a gap";
}

TEST(StrandSprings, StrandsWithinABodyDrawItTogether) {
  test::SceneFolder folder;
  const auto slack = trough(folder, true, "slack=\"1.2\""),
             taut = trough(folder, true, "slack=\"0.8\" stiffness=\"2 N/m\"");
  ASSERT_TRUE(slack && taut);
  slack->step();
  for (int n = 0; n < 600; ++n) taut->step();
  const auto before = Strands(*slack).now(), after = Strands(*taut).now();
  ASSERT_EQ(before.size(), after.size());
  for (std::size_t i = 0; i < after.size(); ++i) {
    const double rest = 0.8 * (before[i].a - before[i].b).norm(),
                 tension = 2 * ((after[i].a - after[i].b).norm() - rest);
    EXPECT_LT(tension, 2 * 0.25 * rest) << "the walls did not come nearer";
    EXPECT_NEAR(after[i].tension, std::max(0.0, tension), 1e-9);
  }
}

}  // namespace
}  // namespace insula
