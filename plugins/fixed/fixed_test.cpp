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

TEST_F(FixedRegion, InsideAndOutsideOfABox) {
  const auto box = [](const Vec3& x) {
    return std::abs(x.x() - 0.01) < 0.011 && std::abs(x.y() - 0.02) < 1e-6 && std::abs(x.z() - 0.03) < 0.011;
  };
  // The faces lie on nodes, which belong to the box.
  EXPECT_EQ(held("<fixed region=\"box\" centre=\"1 2 3 cm\" size=\"2 0 2 cm\"/>", box), 9);
  EXPECT_EQ(held("<fixed region=\"outside_box\" centre=\"1 2 3 cm\" size=\"2 0 2 cm\"/>",
                 [&](const Vec3& x) { return !box(x); }),
            116);
}

TEST_F(FixedRegion, ConditionsIntersect) {
  EXPECT_EQ(held("<fixed region=\"beyond\" centre=\"0 0 35 mm\"><where region=\"box\" centre=\"2 2 2 cm\" size=\"2 4 "
                 "4 cm\"/><where region=\"outside\" centre=\"2 2 4 cm\" radius=\"5 mm\"/></fixed>",
                 [](const Vec3& x) {
                   return x.z() > 0.035 && std::abs(x.x() - 0.02) < 0.011 && (x - Vec3(0.02, 0.02, 0.04)).norm() > 5e-3;
                 }),
            14);
}

TEST_F(FixedRegion, ConditionsConcernTheirOwnSupportOnly) {
  EXPECT_EQ(held("<fixed region=\"beyond\" centre=\"0 0 35 mm\"/><fixed><where region=\"beyond\" centre=\"35 0 0 mm\" "
                 "normal=\"1 0 0\"/></fixed>",
                 [](const Vec3& x) { return x.z() > 0.035 || x.x() > 0.035; }),
            45);
}

TEST_F(FixedRegion, ListedNodes) {
  const auto rest = test::block_mesh({4, 4, 4}, Vec3::Zero(), Vec3::Constant(0.04)).nodes;
  const auto is = [&](const Vec3& x, std::size_t i) { return (x - rest[i]).norm() < 1e-9; };
  EXPECT_EQ(
      held("<fixed nodes=\"0 124\n 17 17\"/>", [&](const Vec3& x) { return is(x, 0) || is(x, 17) || is(x, 124); }), 3);
  // Only the listed nodes of the region.
  ASSERT_LT(rest[0].z(), 0.035);
  EXPECT_EQ(held("<fixed region=\"beyond\" centre=\"0 0 35 mm\" nodes=\"0 124\"/>",
                 [&](const Vec3& x) { return is(x, 124); }),
            1);
  EXPECT_EQ(
      held("<fixed><where nodes=\"3 4\"/><where nodes=\"4 5\"/></fixed>", [&](const Vec3& x) { return is(x, 4); }), 1);
}

TEST_F(FixedRegion, MistakesAreNamedWhereTheyStand) {
  const std::size_t before = scene("").find("</soft_body>");
  const auto message = [&](const std::string& supports, std::string_view at) {
    const std::string column = std::to_string(before + supports.find(at) + 1);
    const auto result = load_simulation_text(scene(supports), folder_.path() / "cube.xml", test::builtin(), 1);
    EXPECT_FALSE(result.simulation) << supports;
    const std::string text = result.diagnostics.format(), place = "cube.xml:1:" + column + ": error: ";
    EXPECT_EQ(result.diagnostics.errors(), 1) << text;
    const std::size_t found = text.find(place);
    EXPECT_NE(found, std::string::npos) << place << "\n" << text;
    return found == std::string::npos ? text : text.substr(found + place.size());
  };
  EXPECT_EQ(message("<fixed region=\"inside\" centre=\"2 2 2 m\" radius=\"10 mm\"/>", "<fixed"),
            "holds no node; is the region elsewhere, or its unit another one?\n");
  EXPECT_EQ(message("<fixed nodes=\"0 125\"/>", "0 125"),
            "nodes: 125 is no node of the body, which has the nodes 0 to 124\n");
  EXPECT_EQ(message("<fixed nodes=\"99999999999999999999999\"/>", "999"),
            "nodes: 99999999999999999999999 is no node of the body, which has the nodes 0 to 124\n");
  for (const char* word : {"-1", "1.5", "1,2", "a", "0x1"})
    EXPECT_EQ(message("<fixed nodes=\"" + std::string(word) + "\"/>", word),
              "nodes: \"" + std::string(word) + "\" is not the index of a node (a whole number from 0)\n");
  EXPECT_EQ(message("<fixed nodes=\" \"/>", " \"/>"), "nodes: lists no node; remove it to mean all of the region\n");
  EXPECT_EQ(message("<fixed><where nodes=\"125\"/></fixed>", "125"),
            "nodes: 125 is no node of the body, which has the nodes 0 to 124\n");
  EXPECT_EQ(message("<fixed region=\"box\"/>", "box"), "region: a box needs its size\n");
  EXPECT_EQ(message("<fixed size=\"1 1 1 cm\"/>", "1 1 1"),
            "size: only a box has a size; write region=\"box\", or remove it\n");
  EXPECT_EQ(message("<fixed><where region=\"outside_box\"/></fixed>", "outside_box"), "region: a box needs its size\n");
  EXPECT_EQ(message("<fixed region=\"beyond\" centre=\"0 0 35 mm\"><where region=\"inside\" radius=\"5 mm\"/></fixed>",
                    "<fixed"),
            "holds no node: it selects 25, and none of them satisfies all of its conditions\n");
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
