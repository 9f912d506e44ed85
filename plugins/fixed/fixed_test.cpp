// SPDX-License-Identifier: GPL-3.0-or-later
// Which nodes each region holds.
#include <gtest/gtest.h>

#include "core/mechanics/soft_body.h"
#include "core/testing/block_mesh.h"
#include "core/testing/example.h"
#include "core/testing/held.h"

namespace insula {
namespace {

class FixedRegion : public ::testing::Test {
 protected:
  FixedRegion() {
    folder_.write("meshes/cube.msh", test::gmsh_text(test::block_mesh({4, 4, 4}, Vec3::Zero(), Vec3::Constant(0.04))));
  }
  std::string scene(const std::string& supports) const {
    return "<scene gravity=\"0 0 -9.81 m/s2\"><soft_body id=\"cube\" mesh=\"meshes/cube.msh\" "
           "mesh_unit=\"m\"><corotational_fem/>" +
           supports + "</soft_body></scene>";
  }
  /// Number of fixed nodes; each must satisfy `inside`, no free one may.
  int held(const std::string& supports, const std::function<bool(const Vec3&)>& inside) const {
    auto s = test::load_text(scene(supports), folder_.path() / "cube.xml");
    EXPECT_TRUE(s);
    if (!s) return -1;
    auto& body = *s->scene().find_as<SoftBody>("cube");
    int count = 0;
    for (int i = 0; i < body.nodes(); ++i) {
      EXPECT_EQ(bool(body.fixed()[std::size_t(i)]), inside(body.rest().nodes[std::size_t(i)])) << "node " << i;
      count += body.fixed()[std::size_t(i)];
    }
    s->step();
    return count;
  }
  test::SceneFolder folder_;
};

TEST_F(FixedRegion, All) {
  EXPECT_EQ(held("<fixed/>", [](const Vec3&) { return true; }), 125);
}

TEST_F(FixedRegion, InsideAndOutsideOfABall) {
  const auto ball = [](const Vec3& x) { return (x - Vec3::Constant(0.02)).norm() <= 0.0105; };
  EXPECT_EQ(held("<fixed region=\"inside\" centre=\"2 2 2 cm\" radius=\"10.5 mm\"/>", ball), 7);
  EXPECT_EQ(held("<fixed region=\"outside\" centre=\"2 2 2 cm\" radius=\"10.5 mm\"/>",
                 [&](const Vec3& x) { return !ball(x); }),
            118);
}

TEST_F(FixedRegion, BeyondAPlane) {
  EXPECT_EQ(held("<fixed region=\"beyond\" centre=\"0 0 35 mm\" normal=\"0 0 2\"/>",
                 [](const Vec3& x) { return x.z() > 0.035; }),
            25);
}

TEST_F(FixedRegion, SeveralAddUp) {
  EXPECT_EQ(held("<fixed region=\"beyond\" centre=\"0 0 35 mm\" normal=\"0 0 1\"/><fixed region=\"beyond\" centre=\"5 "
                 "0 0 mm\" normal=\"-1 0 0\"/>",
                 [](const Vec3& x) { return x.z() > 0.035 || x.x() < 0.005; }),
            45);
}

TEST_F(FixedRegion, HoldingNothingIsAnError) {
  const auto result = load_simulation_text(scene("<fixed region=\"inside\" centre=\"2 2 2 m\" radius=\"10 mm\"/>"),
                                           folder_.path() / "cube.xml", test::builtin(), 1);
  EXPECT_FALSE(result.simulation);
  EXPECT_NE(result.diagnostics.format().find("holds no node"), std::string::npos) << result.diagnostics.format();
}

// What is held carries the weight of what is not: the reaction is the weight, and fixed nodes stay to the bit.
TEST_F(FixedRegion, FixedNodesStay) {
  auto s = test::load_text(scene("<fixed region=\"beyond\" centre=\"0 0 5 mm\" normal=\"0 0 -1\"/>"),
                           folder_.path() / "cube.xml");
  ASSERT_TRUE(s);
  auto& body = *s->scene().find_as<SoftBody>("cube");
  for (int i = 0; i < 600; ++i) s->step();
  VecX f = VecX::Zero(body.q().size());
  for (ForceModel* m : body.forces()) m->linearise(body.q().data(), f.data(), nullptr, 0, Tangent::system);
  double reaction = 0, weight = 0;
  for (int i = 0; i < body.nodes(); ++i) {
    if (body.fixed()[std::size_t(i)]) {
      EXPECT_TRUE((body.q().segment<3>(3 * i) == body.rest().nodes[std::size_t(i)]));
      reaction -= f[3 * i + 2];
    } else {
      weight += 9.81 * body.node_mass()[std::size_t(i)];
    }
  }
  EXPECT_TRUE(test::held("reaction of fixed nodes = weight", std::abs(reaction - weight), weight, 1e-6));
}

}  // namespace
}  // namespace insula
