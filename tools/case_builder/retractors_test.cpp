// SPDX-License-Identifier: GPL-3.0-or-later
// Retractors of an author's own: how they are read, what is refused, and how they stand in the scene.
#include "tools/case_builder/retractors.h"

#include <gtest/gtest.h>

#include "core/base/input_error.h"
#include "core/mechanics/instrument.h"
#include "core/mechanics/soft_body.h"
#include "core/registry/registry.h"
#include "core/sim/simulation.h"
#include "tools/case_builder/fissure.h"
#include "tools/case_builder/project.h"
#include "tools/case_builder/scene_text.h"
#include "tools/case_builder/shapes_for_test.h"
#include "tools/case_builder/standing.h"

namespace insula::case_builder {
namespace {

const fs::path project = find_project(INSULA_SOURCE_DIR);

std::string refusal(const std::string& text) {
  try {
    read_retractor(text);
  } catch (const InputError& e) {
    return e.what();
  }
  return {};
}

TEST(Retractors, AreReadWithWhatIsGiven) {
  const RetractorChoice all = read_retractor("frontal, 5.35 1.5 -0.1 cm, shaft=0.8 0.2 0.5, flat=0 -0.1 1, pull=5 mm");
  EXPECT_EQ(all.lobe, "frontal");
  EXPECT_NEAR(all.tip[0], 53.5, 1e-9);
  ASSERT_TRUE(all.shaft && all.flat && all.pull);
  EXPECT_EQ(*all.pull, 5);
  EXPECT_FALSE(read_retractor("temporal, 1 2 3 mm").shaft);
  EXPECT_NE(refusal("frontal, 1 2 3").find("1 2 3 mm"), std::string::npos);
  EXPECT_NE(refusal("frontal, 1 2 3 mm, pull=16 mm").find("0 mm to 15 mm"), std::string::npos);
  EXPECT_NE(refusal("1 2 3 mm").find("names no lobe"), std::string::npos);
  EXPECT_NE(refusal("frontal, 1 2 3 mm, shaft=0 0 0").find("must not be zero"), std::string::npos);
}

TEST(Retractors, StandWhereLobesAndArmsAre) {
  const Approach sylvian = read_approach(project, "sylvian");
  const Fissure fissure = read_fissure(project, {}, sylvian);
  ASSERT_EQ(fissure.proposed.size(), 2u);
  EXPECT_EQ(fissure.proposed[0].lobe, "temporal");
  EXPECT_EQ(fissure.proposed[1].lobe, "frontal");
  const auto chosen = [&](const std::string& text) {
    return chosen_retractors({read_retractor(text)}, fissure.proposed, sylvian);
  };
  EXPECT_LT((chosen("frontal, 53 15 0 mm")[0].shaft - fissure.proposed[1].shaft).norm(), 1e-9);
  EXPECT_THROW(chosen("occipital, 53 15 0 mm"), InputError);
  EXPECT_THROW(chosen("frontal, 53 15 40 mm"), InputError);
  EXPECT_THROW(chosen("frontal, 53 15 0 mm, shaft=-1 0 0"), InputError);
}

/// The fissure with these retractors, settled.
SimulationResult settled(const insula::test::SceneFolder& folder, const std::vector<RetractorAt>& retractors) {
  SceneFacts f;
  f.approach = read_approach(project, "sylvian");
  f.assets = link_assets({folder.path(), "case"}, project, {}, f.approach);
  f.assets.lobes = "../../meshes/lobes";
  fs::copy(project / "meshes/lobes", folder.path() / "meshes/lobes", fs::copy_options::recursive);
  f.retractors = retractors;
  folder.write("retractors.xml", retractors_part(f));
  folder.write("scene.xml", "<scene><include file=\"retractors.xml\"/><settle time=\"3 s\"/></scene>");
  Registry registry;
  register_builtin(registry);
  SimulationResult loaded = load_simulation(folder.path() / "scene.xml", registry, 1);
  EXPECT_TRUE(loaded.simulation) << loaded.diagnostics.format();
  if (loaded.simulation) loaded.simulation->step();
  return loaded;
}

TEST(Retractors, OneThatIsPlacedStandsThereAndPushesItsLobe) {
  const Approach sylvian = read_approach(project, "sylvian");
  const Fissure fissure = read_fissure(project, {}, sylvian);
  // A millimetre farther into the frontal lobe than the approach's own.
  const auto all = chosen_retractors(
      {read_retractor("temporal, 54.13 11.179 -9.821 mm"), read_retractor("frontal, 53.5 14.958 0.945 mm, pull=6 mm")},
      fissure.proposed, sylvian);
  const insula::test::SceneFolder folder;
  const SimulationResult made = settled(folder, all);
  ASSERT_TRUE(made.simulation);
  const auto& arms = made.simulation->instruments();
  ASSERT_EQ(arms.size(), 2u);
  const Vec3 tips[] = {{54.13, 11.179, -9.821}, {53.5, 14.958, 0.945}};
  for (std::size_t k = 0; k < 2; ++k) {
    EXPECT_LT((1000 * arms[k]->home_pose().p - tips[k]).norm(), 1e-3);
    EXPECT_LT((arms[k]->home_pose().q * Vec3::UnitZ() - fissure.proposed[k].shaft).norm(), 1e-3);
  }
  const Standing standing = standing_of(*made.simulation);
  ASSERT_EQ(standing.arms.size(), 2u);
  EXPECT_EQ(standing.arms[0].lobe, "temporal");
  EXPECT_EQ(standing.arms[1].lobe, "frontal");
  EXPECT_GT(standing.arms[1].force, 0.02);
}

}  // namespace
}  // namespace insula::case_builder
