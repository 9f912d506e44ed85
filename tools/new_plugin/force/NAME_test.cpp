// SPDX-License-Identifier: GPL-3.0-or-later
// The energy of a tetrahedron that is made larger as a whole is the sum over its six edges.
#include <gtest/gtest.h>

#include "core/testing/block_mesh.h"
#include "core/testing/example.h"

namespace insula {
namespace {

TEST(@Name@, EnergyOfAnEvenStretch) {
  test::SceneFolder folder;
  folder.write("meshes/tet.msh", test::gmsh_text(test::single_tet(0.01)));
  auto s = test::load_text(R"(<scene>
  <soft_body id="b" mesh="meshes/tet.msh" mesh_unit="m"><corotational_fem/><@name@ id="springs" stiffness="50 N/m"/></soft_body></scene>)",
                           folder.path() / "scene.xml");
  ASSERT_TRUE(s);
  auto* springs = s->scene().find_as<ForceModel>("springs");
  auto* body = s->scene().find_as<SoftBody>("b");
  ASSERT_TRUE(springs && body);
  const double strain = 0.2;
  const VecX x = (1 + strain) * body->q();
  // Three edges of a, three of sqrt(2) a: sum of L^2 = 3 a^2 + 6 a^2.
  EXPECT_NEAR(springs->energy(x.data()), 0.5 * 50 * strain * strain * 9 * 0.01 * 0.01, 1e-15);
  EXPECT_EQ(springs->energy(body->q().data()), 0);
}

}  // namespace
}  // namespace insula
