// SPDX-License-Identifier: GPL-3.0-or-later
// A spatula against tissue: the hand carries what the contacts push with, an arm yields by its stiffness alone.
#include <gtest/gtest.h>

#include "core/testing/block_mesh.h"
#include "core/testing/example.h"
#include "core/testing/held.h"

namespace insula {
namespace {

struct Bed {
  test::SceneFolder folder;
  std::unique_ptr<Simulation> s;
  Instrument* spatula = nullptr;
  explicit Bed(const std::string& hand, const std::string& home) {
    folder.write("meshes/block.msh",
                 test::gmsh_text(test::block_mesh({4, 4, 4}, Vec3(-0.01, -0.01, -0.02), Vec3(0.01, 0.01, 0))));
    folder.write("meshes/spatula/spatula.urdf", test::test_tool_urdf(0.002));
    s = test::load_text(R"(<scene><solver tolerance="1e-15 m" max_sweeps="10000"/>
      <soft_body id="block" mesh="meshes/block.msh" mesh_unit="m"><corotational_fem/>
        <fixed region="beyond" centre="0 0 -19 mm" normal="0 0 -1"/><surface/></soft_body>
      <retractor id="spatula" model="meshes/spatula/spatula.urdf" hand=")" +
                            hand + R"(" home=")" + home + R"(" shaft="0 0 1" flat="1 0 0" coupling="500 N/m"/>
      <contact between="spatula block" friction="0.2"/></scene>)",
                        folder.path() / "retractor.xml");
    if (s) spatula = s->scene().find_as<Instrument>("spatula");
  }
  Vec3 contact_force() const {
    Vec3 sum = Vec3::Zero();
    for (const ContactPoint& c : s->report().contacts) {
      if (c.a == spatula) sum += c.normal_force * c.normal + c.tangent_force;
      if (c.b == spatula) sum -= c.normal_force * c.normal + c.tangent_force;
    }
    return sum;
  }
};

TEST(Retractor, TheHandCarriesTheContactForce) {
  Bed t("left", "0.3 0.2 4 mm");
  ASSERT_TRUE(t.spatula);
  EXPECT_FALSE(t.spatula->cutting());
  double most = 0;
  for (int n = 0; n < 120; ++n) {
    HandState hand;
    hand.present = true;
    hand.device = t.spatula->home_pose();
    hand.device.p.z() -= 0.0001 * std::min(n, 60);
    t.s->set_hand(0, hand);
    t.s->step();
    const Vec3 f = t.contact_force();
    EXPECT_TRUE(test::held("the hand carries the contact, N", (t.spatula->hand_force().head<3>() - f).norm(), 1, 1e-9))
        << "step " << n;
    EXPECT_LT((t.s->report().structures.at(0).of_hand[0] + f).norm(), 1e-9);
    most = std::max(most, f.z());
  }
  EXPECT_GT(most, 0.01) << "it never pressed";
  EXPECT_LT(most, 1) << "soft tissue pushes back softly";
}

TEST(Retractor, AnArmHoldsItAtHomeWhateverTheHandsDo) {
  Bed t("none", "0.3 0.2 0.5 mm");  // pressed 1.5 mm into the block
  ASSERT_TRUE(t.spatula);
  for (int n = 0; n < 120; ++n) {
    test::drive(*t.s);
    t.s->step();
  }
  const Vec3 f = t.contact_force(), moved = t.spatula->pose().p - t.spatula->home_pose().p;
  EXPECT_GT(f.z(), 0.005);
  EXPECT_LT((moved - f / 500).norm(), 1e-3 * moved.norm());
  EXPECT_EQ(t.s->report().structures.at(0).largest(), 0) << "no hand presses";
}

}  // namespace
}  // namespace insula
