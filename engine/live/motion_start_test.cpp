// SPDX-License-Identifier: GPL-3.0-or-later
// Which first poses of a motion are refused, and what the message says.
#include "engine/live/motion_start.h"

#include <gtest/gtest.h>

#include <sstream>

#include "core/base/input_error.h"
#include "core/testing/block_mesh.h"
#include "core/testing/example.h"
#include "engine/live/headless.h"

namespace insula {
namespace {

constexpr const char* header = "time_s,hand,px_m,py_m,pz_m,qw,qx,qy,qz,button1,button2\n";

// A block of 40 x 40 x 20 mm with its top at z = 0, a rod of 30 mm upright 20 mm above it, and an arm's rod beside it.
class MotionStart : public testing::Test {
 protected:
  void SetUp() override {
    scene_.write("meshes/block.msh",
                 test::gmsh_text(test::block_mesh({4, 4, 2}, {-0.02, -0.02, -0.02}, {0.02, 0.02, 0})));
    std::string urdf = test::test_tool_urdf(0.0005);
    const std::string tip = R"(<collision name="tip"><geometry><sphere radius="0.0005"/></geometry>)";
    ASSERT_NE(urdf.find(tip), std::string::npos);
    urdf.replace(urdf.find(tip), tip.size(), R"(<collision name="rod"><origin xyz="0 0 0.0145" rpy="0 0 0"/>
      <geometry><cylinder radius="0.0005" length="0.03"/></geometry>)");
    scene_.write("meshes/probe/probe.urdf", urdf);
    scene_.write("meshes/probe/tool.json", test::test_tool_json(0, 0));
    simulation_ = load("probe block blade");
    ASSERT_TRUE(simulation_);
  }
  std::string text(const std::string& touching) const {
    return R"(<scene>
  <soft_body id="block" mesh="meshes/block.msh" mesh_unit="m"><corotational_fem/><fixed region="beyond" centre="0 0 -19 mm" normal="0 0 -1"/>
    <surface/></soft_body>
  <retractor id="probe" hand="right" model="meshes/probe/probe.urdf" home="0 0 20 mm" shaft="0 0 1" flat="1 0 0"/>
  <retractor id="other" hand="right" model="meshes/probe/probe.urdf" home="0 0 20 mm" shaft="0 0 1" flat="1 0 0"/>
  <retractor id="blade" hand="none" model="meshes/probe/probe.urdf" home="15 0 10 mm" shaft="0 0 1" flat="1 0 0"/>
  <contact between=")" +
           touching + "\"/>\n</scene>";
  }
  std::unique_ptr<Simulation> load(const std::string& touching) const {
    return test::load_text(text(touching), scene_.path() / "scene.xml");
  }
  /// The message for a motion of these rows; empty if it may start.
  static std::string refusal(const Simulation& s, const std::string& rows) {
    try {
      check_start(s, parse_motion(header + rows, "m.csv"));
    } catch (const InputError& e) {
      return e.what();
    }
    return {};
  }
  std::string refusal(const std::string& rows) const { return refusal(*simulation_, rows); }
  test::SceneFolder scene_;
  std::unique_ptr<Simulation> simulation_;
};

TEST_F(MotionStart, AtHomeOrThroughFreeSpaceIsAccepted) {
  EXPECT_EQ(refusal("0,right,0,0,0.02,1,0,0,0,0,0\n"), "");
  EXPECT_EQ(refusal("0,right,0,0,0.001,1,0,0,0,0,0\n"), "");  // above the block
  EXPECT_EQ(refusal("0,right,-0.05,0,0.03,1,0,0,0,0,0\n"), "");
  EXPECT_EQ(refusal("1,command,message,hello\n"), "");  // no hand
}

TEST_F(MotionStart, BehindABodyIsRefusedWithTheDistanceTheBodyAndTheHome) {
  EXPECT_EQ(
      refusal("0,right,0,0,-0.03,1,0,0,0,0,0\n"),
      "the motion starts 50.0 mm and 0 degrees away from the home of \"probe\" in the right hand, and \"block\" is "
      "in the way; begin at the home (0,0,0.02,1,0,0,0) and lead the hand to the first pose");
}

TEST_F(MotionStart, InContactIsAcceptedToADepthOfTenMillimetres) {
  EXPECT_EQ(refusal("0,right,0,0,0.0004,1,0,0,0,0,0\n"), "");
  EXPECT_EQ(refusal("0,right,0,0,-0.009,1,0,0,0,0,0\n"), "");
  EXPECT_NE(refusal("0,right,0,0,-0.011,1,0,0,0,0,0\n").find("\"block\" is in the way"), std::string::npos);
}

TEST_F(MotionStart, BehindARigidBodyIsRefused) {
  EXPECT_NE(refusal("0,right,0.03,0,0.02,1,0,0,0,0,0\n").find("\"blade\" is in the way"), std::string::npos);
  EXPECT_EQ(refusal("0,right,0,0.03,0.02,1,0,0,0,0,0\n"), "");
}

TEST_F(MotionStart, ATurnThatSweepsTheToolThroughABodyIsRefused) {
  // The handle, above the tip at home, is turned to below it.
  EXPECT_NE(refusal("0,right,0,0,0.02,0,1,0,0,0,0\n").find("0.0 mm and 180 degrees"), std::string::npos);
}

TEST_F(MotionStart, WhatTheToolDoesNotTouchIsNotInItsWay) {
  const auto loose = load("other block blade");
  ASSERT_TRUE(loose);
  EXPECT_EQ(refusal(*loose, "0,right,0,0,-0.03,1,0,0,0,0,0\n"), "");
}

TEST_F(MotionStart, TooFarAwayIsRefused) {
  EXPECT_EQ(refusal("0,right,0,0,0.119,1,0,0,0,0,0\n"), "");
  EXPECT_NE(refusal("0,right,0,0,0.121,1,0,0,0,0,0\n")
                .find("101.0 mm and 0 degrees away from the home of \"probe\" in the "
                      "right hand, more than the 100 mm that are allowed"),
            std::string::npos);
}

TEST_F(MotionStart, AnExchangeAtTheStartPutsTheToolIntoTheHand) {
  const std::string far = "0,right,0,0,-0.03,1,0,0,0,0,0\n";
  EXPECT_EQ(refusal(far + "0,command,exchange,right other\n"), "");
  EXPECT_NE(refusal(far + "1,command,exchange,right other\n"), "");
  EXPECT_NE(refusal(far + "0,command,exchange,left other\n"), "");
}

// What the check is for: contact stops the tool, and the coupling presses it with the rest of the way.
TEST_F(MotionStart, WhatIsRefusedWouldPressHard) {
  HandState hand;
  hand.present = true;
  hand.device.p = Vec3(0, 0, -0.03);
  simulation_->set_hand(1, hand);
  simulation_->step();
  EXPECT_GT(simulation_->instrument_of(1)->hand_force().head<3>().norm(), 5);
}

TEST_F(MotionStart, ARunIsRefusedAndTheAdviceHelps) {
  scene_.write("scene.xml", text("probe block blade"));
  const auto opens = [&](const std::string& rows, bool optional, std::string& said) {
    scene_.write("m.csv", header + rows);
    std::ostringstream out, err;
    CommandContext context{test::builtin(), out, err};
    const OpenedRun run =
        open_run(context, scene_.path() / "scene.xml", (scene_.path() / "m.csv").string(), optional, 1);
    said = err.str();
    return run.simulation != nullptr;
  };
  std::string said;
  for (const bool optional : {false, true}) {
    EXPECT_FALSE(opens("0,right,0,0,-0.03,1,0,0,0,0,0\n", optional, said));
    EXPECT_NE(said.find("scene.xml: error: the motion starts 50.0 mm"), std::string::npos) << said;
  }
  EXPECT_TRUE(opens("0,right,0,0,0.02,1,0,0,0,0,0\n1,right,0.05,0,0.02,1,0,0,0,0,0\n2,right,0.05,0,-0.03,1,0,0,0,0,0\n",
                    false, said))
      << said;
}

}  // namespace
}  // namespace insula
