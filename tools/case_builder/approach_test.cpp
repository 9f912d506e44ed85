// SPDX-License-Identifier: GPL-3.0-or-later
// The approaches of the project hang together: parts, meshes and the placed neck belong to one another.
#include "tools/case_builder/approach.h"

#include <gtest/gtest.h>

#include "core/base/input_error.h"
#include "core/testing/block_mesh.h"
#include "tools/case_builder/fissure.h"
#include "tools/case_builder/project.h"
#include "tools/case_builder/solid.h"

namespace insula::case_builder {
namespace {

class ShippedApproach : public testing::TestWithParam<const char*> {
 protected:
  const fs::path project = find_project(INSULA_SOURCE_DIR);
  const Approach approach = read_approach(project, GetParam());
};
INSTANTIATE_TEST_SUITE_P(All, ShippedApproach,
                         testing::Values("sylvian", "interhemispheric", "basal_interhemispheric", "pretemporal",
                                         "pterional"),
                         [](const auto& one) { return std::string(one.param); });

TEST_P(ShippedApproach, ItsScenePartHasItsLobesAndHoldsTheNodesThatItSays) {
  const Fissure fissure = read_fissure(project, {}, approach);
  ASSERT_EQ(fissure.lobes.size(), 2u);
  for (const Lobe& lobe : fissure.lobes) {
    EXPECT_TRUE(lobe.name == approach.lobes[0] || lobe.name == approach.lobes[1]) << lobe.name;
    for (std::size_t i = 0; i < lobe.tets.nodes.size(); ++i)
      EXPECT_EQ(bool(lobe.fixed[i]), (lobe.tets.nodes[i] - approach.centre).norm() > approach.held) << lobe.name;
  }
}

TEST_P(ShippedApproach, TheNeckLiesInFrontOfTheFloorAndTheSurgeonSeesItAlongTheFissure) {
  const Fissure fissure = read_fissure(project, {}, approach);
  const Solid floor(fissure.floor);
  EXPECT_LT((approach.neck - approach.centre).norm(), approach.held);
  const Nearest below = floor.nearest(approach.neck, 20);
  ASSERT_TRUE(below.found);
  EXPECT_GT(below.distance, 1);
  EXPECT_GT(below.outward.dot(approach.to_surgeon), 0.3);
  EXPECT_GT(approach.sac_points.dot(approach.to_surgeon), 0.5) << "the dome points to the surgeon's side";
}

TEST_P(ShippedApproach, LobesOfAnotherFrameAreRefused) {
  insula::test::SceneFolder folder;
  for (const std::string& lobe : approach.lobes)
    for (const char* tail : {".msh", "_surface.ply"})
      fs::copy(approach.folder / (lobe + tail), folder.path() / (lobe + tail));
  fs::copy(approach.folder / (approach.floor + "_surface.ply"), folder.path() / (approach.floor + "_surface.ply"));
  EXPECT_NO_THROW(read_fissure(project, folder.path(), approach));
  Approach elsewhere = approach;
  elsewhere.held = 1000;
  EXPECT_THROW(read_fissure(project, folder.path(), elsewhere), InputError);
}

TEST(Approaches, AnUnknownNameIsRefusedWithThoseThatThereAre) {
  try {
    read_approach(find_project(INSULA_SOURCE_DIR), "transorbital");
    FAIL();
  } catch (const InputError& e) {
    EXPECT_NE(std::string(e.what()).find("interhemispheric, pretemporal, pterional, sylvian"), std::string::npos)
        << e.what();
  }
}

}  // namespace
}  // namespace insula::case_builder
