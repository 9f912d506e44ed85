// SPDX-License-Identifier: GPL-3.0-or-later
// Nodes within the ball stay to the bit under weight; the others sink.
#include <gtest/gtest.h>

#include "core/mechanics/deformable_body.h"
#include "core/testing/block_mesh.h"
#include "core/testing/example.h"

namespace insula {
namespace {

TEST(@Name@, HoldsWhatLiesWithinItsBall) {
  test::SceneFolder folder;
  folder.write("meshes/tet.msh", test::gmsh_text(test::single_tet(0.01)));
  auto s = test::load_text(R"(<scene gravity="0 0 -9.81 m/s2">
  <soft_body id="b" mesh="meshes/tet.msh" mesh_unit="m"><corotational_fem/><@name@ centre="0 0 0 mm" radius="1 mm"/>
  <surface id="skin"/></soft_body></scene>)",
                           folder.path() / "scene.xml");
  ASSERT_TRUE(s);
  const auto* body = dynamic_cast<const DeformableBody*>(s->bodies()[0]);
  ASSERT_TRUE(body);
  for (int k = 0; k < 5; ++k) s->step();
  for (int i = 0; i < body->nodes(); ++i) {
    const Vec3& rest = body->rest_nodes()[std::size_t(i)];
    const double moved = (body->q().segment<3>(3 * i) - rest).norm();
    if (rest.norm() < 0.001) EXPECT_EQ(moved, 0.0) << "node " << i;
    else EXPECT_GT(moved, 0.0) << "node " << i;
  }
}

}  // namespace
}  // namespace insula
