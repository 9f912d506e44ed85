// SPDX-License-Identifier: GPL-3.0-or-later
// On a rigid body the force is minus stiffness times stretch, to either side.
#include <gtest/gtest.h>

#include "core/testing/block_mesh.h"
#include "core/testing/example.h"

namespace insula {
namespace {

/// Force of a spring of 40 N/m over 20 mm that is `length` long without force.
double force(const std::string& length) {
  test::SceneFolder folder;
  folder.write("meshes/tet.msh", test::gmsh_text(test::single_tet(0.01)));
  auto s = test::load_text(R"(<scene>
  <soft_body id="b" mesh="meshes/tet.msh" mesh_unit="m"><corotational_fem/><fixed/><surface id="skin"/></soft_body>
  <@name@ surface="skin" at="0 0 10 mm" anchor="0 0 30 mm" stiffness="40 N/m" length=")" +
                               length + "\"/></scene>",
                           folder.path() / "scene.xml");
  if (!s) return 0;
  s->step();
  return s->problem().rows == 1 ? s->problem().lambda[0] : 0;
}

TEST(@Name@, PullsWhenItIsStretched) { EXPECT_NEAR(force("15 mm"), -40 * 0.005, 1e-12); }
TEST(@Name@, PushesWhenItIsShortened) { EXPECT_NEAR(force("25 mm"), 40 * 0.005, 1e-12); }

}  // namespace
}  // namespace insula
