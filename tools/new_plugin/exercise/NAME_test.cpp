// SPDX-License-Identifier: GPL-3.0-or-later
// The goal is reached after the hold time, not a step sooner; leaving before counts as one fault.
#include <gtest/gtest.h>

#include "core/testing/block_mesh.h"
#include "core/testing/example.h"

namespace insula {
namespace {

class @Name@Rule : public ::testing::Test {
 protected:
  void SetUp() override {
    folder.write("meshes/pen.urdf", test::test_tool_urdf(0.001));
    folder.write("meshes/tool.json", test::test_tool_json(0, 0));
    s = test::load_text(R"(<scene time_step="20 ms">
  <dissector id="probe" model="meshes/pen.urdf" hand="right" home="0 0 0 mm" shaft="0 0 1" flat="1 0 0" sharp="never"/>
  <exercise id="e" title="t"><@name@ id="steady" at="10 0 0 mm" distance="1 mm" hold="100 ms"/></exercise></scene>)",
                        folder.path() / "scene.xml");
    ASSERT_TRUE(s && s->exercise());
  }
  void hold_at(double x, int steps) {
    HandState hand;
    hand.present = true;
    hand.device = s->instrument_of(1)->home_pose();
    hand.device.p.x() = x;
    s->set_hand(1, hand);
    for (int i = 0; i < steps; ++i) s->step();
  }
  bool reached() const { return s->exercise()->log().goals().at(0).done; }
  int faults() const { return s->exercise()->log().faults().at(0).count; }
  test::SceneFolder folder;
  std::unique_ptr<Simulation> s;
};

TEST_F(@Name@Rule, IsReachedAfterTheHoldTime) {
  hold_at(0.0095, 4);  // 80 ms
  EXPECT_FALSE(reached());
  hold_at(0.0095, 1);
  EXPECT_TRUE(reached());
  EXPECT_EQ(faults(), 0);
}

TEST_F(@Name@Rule, LeavingTooSoonIsAFault) {
  hold_at(0.0095, 2);
  hold_at(0.02, 3);
  EXPECT_FALSE(reached());
  EXPECT_EQ(faults(), 1);
}

}  // namespace
}  // namespace insula
