// SPDX-License-Identifier: GPL-3.0-or-later
// Suction: takes what is near, holds up to pressure times area, lets go beyond, and only while the button is held.
#include <gtest/gtest.h>

#include <cmath>

#include "core/testing/block_mesh.h"
#include "core/testing/example.h"
#include "core/testing/held_tool.h"
#include "tests/figures/figure.h"

namespace insula {
namespace {

constexpr double pi = 3.14159265358979323846, radius = 0.0005, vacuum = 15000, limit = vacuum * pi * radius * radius;

struct SuctionBed {
  test::SceneFolder folder;
  std::unique_ptr<Simulation> s;
  Instrument* tube = nullptr;
  explicit SuctionBed(double height = 0.0005) {
    folder.write("meshes/block.msh",
                 test::gmsh_text(test::block_mesh({2, 2, 2}, Vec3(-0.01, -0.01, -0.02), Vec3(0.01, 0.01, 0))));
    folder.write("meshes/tube/tube.urdf", test::test_tool_urdf(0.0008));
    folder.write("meshes/tube/tool.json", test::test_tool_json(0, radius));
    s = test::load_text(R"(<scene><solver tolerance="1e-15 m" max_sweeps="10000"/>
      <soft_body id="block" mesh="meshes/block.msh" mesh_unit="m"><corotational_fem young="5 kPa"/>
        <fixed region="beyond" centre="0 0 -19 mm" normal="0 0 -1"/><surface/></soft_body>
      <suction id="tube" model="meshes/tube/tube.urdf" hand="left" home="0 0 )" +
                            std::to_string(height * 1000) + R"( mm" shaft="0 0 1" flat="1 0 0"
        suction="15 kPa" capture="1.5 mm" release="3 mm" grip="0.6"/></scene>)",
                        folder.path() / "suction.xml");
    if (s) tube = s->scene().find_as<Instrument>("tube");
  }
  void hold(const Vec3& at, bool button) {
    s->set_hand(0, test::held_at(*tube, at, button));
    s->step();
  }
  /// Forces along the tube and across it, N; false when nothing is held.
  bool forces(Vec3& f) const {
    int k = 0;
    for (const Block& b : s->problem().blocks)
      if (b.owner == tube->order) f[k++] = s->problem().lambda[std::size_t(b.row)];
    return k == 3;
  }
  Vec3 tissue() const {  // the vertex under the tube, node (1, 1, 2) of the block
    return s->scene().find_as<SoftBody>("block")->q().segment<3>(3 * ((1 * 3 + 1) * 3 + 2));
  }
};

TEST(Suction, HoldsUpToPressureTimesAreaAndLetsGo) {
  SuctionBed t;
  ASSERT_TRUE(t.tube);
  ASSERT_LT(t.tissue().norm(), 1e-12);
  double most = 0;
  bool held = false, lost = false, gave_way = false;
  test::Figure figure("suction", "Tissue drawn up by suction: at most pressure x area, then it lets go",
                      "tool drawn up, mm", "force along the tool, mN");
  for (int n = 0; n < 200; ++n) {
    t.hold(Vec3(0, 0, 0.0005 + 0.00005 * n), true);
    Vec3 f;
    const bool holds = t.forces(f);
    figure.law("pressure x area", 0.5 + 0.05 * n, limit * 1e3);
    if (n % 3 == 0) figure.run("force", 0.5 + 0.05 * n, holds ? std::abs(f[0]) * 1e3 : 0);
    if (!holds) {
      EXPECT_TRUE(held) << "never took the tissue";
      lost = true;
      EXPECT_LT(t.tube->hand_force().norm(), 1e-12);
      continue;
    }
    EXPECT_FALSE(lost) << "took the tissue again although it is far, step " << n;
    held = true;
    EXPECT_LE(std::abs(f[0]), limit * (1 + 1e-12));
    EXPECT_LE(f.tail<2>().lpNorm<Eigen::Infinity>(), 0.6 * limit * (1 + 1e-12));
    // The hand feels what the rows carry, and is drawn towards the tissue.
    EXPECT_NEAR(t.tube->hand_force().head<3>().norm(), f.norm(), 1e-12);
    // The pull counts as the hand's force on the tissue.
    const StructureForce& on = t.s->report().structures.at(0);
    EXPECT_LT((on.of_hand[std::size_t(t.tube->hand_index())] + t.tube->hand_force().head<3>()).norm(), 1e-12);
    if (n > 20) {
      EXPECT_LT(t.tube->hand_force()[2], 0);
    }
    most = std::max(most, std::abs(f[0]));
    const double distance = (t.tissue() - t.tube->pose().p).norm();
    if (std::abs(f[0]) < limit * (1 - 1e-9) && n > 0) {
      EXPECT_FALSE(gave_way) << "grips again";
      EXPECT_LT(distance, 1e-9) << "a hold below its limit is rigid, step " << n;
    } else if (n > 20) {
      gave_way = true;
    }
  }
  EXPECT_TRUE(lost) << "never let go";
  EXPECT_NEAR(most, limit, 1e-9 * limit);
}

TEST(Suction, HoldsAcrossUpToGrip) {
  SuctionBed t;
  ASSERT_TRUE(t.tube);
  for (int n = 0; n < 30; ++n) t.hold(Vec3(0, 0, 0.0002), true);
  double most = 0;
  Vec3 f;
  for (int n = 0; n < 100; ++n) {
    t.hold(Vec3(0.00003 * n, 0, 0.0002), true);
    if (!t.forces(f)) break;
    most = std::max(most, f.tail<2>().lpNorm<Eigen::Infinity>());
    EXPECT_LE(f.tail<2>().lpNorm<Eigen::Infinity>(), 0.6 * limit * (1 + 1e-12));
  }
  EXPECT_NEAR(most, 0.6 * limit, 1e-9 * limit);
}

TEST(Suction, OnlyWhileTheButtonIsHeld) {
  SuctionBed t;
  ASSERT_TRUE(t.tube);
  Vec3 f;
  t.hold(Vec3(0, 0, 0.0005), false);
  EXPECT_FALSE(t.forces(f));
  EXPECT_EQ(t.tube->activity(), 0);
  t.hold(Vec3(0, 0, 0.0005), true);
  EXPECT_TRUE(t.forces(f));
  EXPECT_EQ(t.tube->activity(), 1);
  t.hold(Vec3(0, 0, 0.0005), false);
  EXPECT_FALSE(t.forces(f));
}

TEST(Suction, TakesOnlyWhatIsWithinCapture) {
  SuctionBed t(0.002);
  ASSERT_TRUE(t.tube);
  Vec3 f;
  t.hold(Vec3(0, 0, 0.002), true);
  EXPECT_FALSE(t.forces(f));
  for (int n = 0; n < 3; ++n) t.hold(Vec3(0, 0, 0.0014), true);
  EXPECT_TRUE(t.forces(f));
}

}  // namespace
}  // namespace insula
