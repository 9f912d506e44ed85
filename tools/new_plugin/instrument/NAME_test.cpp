// SPDX-License-Identifier: GPL-3.0-or-later
// A mark at once when the button goes down, and one more for each spacing that the tip goes on.
#include <gtest/gtest.h>

#include <algorithm>

#include "core/testing/block_mesh.h"
#include "core/testing/example.h"

namespace insula {
namespace {

/// Marks made while the hand moves sideways by `distance` m in `steps` steps.
int marks(bool button, double distance, int steps) {
  test::SceneFolder folder;
  folder.write("meshes/pen.urdf", test::test_tool_urdf(0.001));
  folder.write("meshes/tool.json", test::test_tool_json(0, 0));
  auto s = test::load_text(
      R"(<scene><@name@ id="pen" model="meshes/pen.urdf" hand="right" home="0 0 0 mm" shaft="0 0 1" flat="1 0 0" spacing="1 mm"/></scene>)",
      folder.path() / "scene.xml");
  if (!s) return -1;
  int count = 0;
  for (int i = 0; i < steps; ++i) {
    HandState hand;
    hand.present = true;
    hand.device = s->instrument_of(1)->home_pose();
    hand.device.p.x() += distance * i / (steps - 1);
    hand.button1 = button;
    s->set_hand(1, hand);
    s->step();
    count +=
        int(std::count_if(s->events().begin(), s->events().end(), [](const Event& e) { return e.kind == "@name@"; }));
  }
  return count;
}

TEST(@Name@, MarksOnceWhileItRests) { EXPECT_EQ(marks(true, 0, 10), 1); }
TEST(@Name@, MarksEachSpacing) { EXPECT_EQ(marks(true, 0.0041, 83), 5); }
TEST(@Name@, MarksNothingWithoutTheButton) { EXPECT_EQ(marks(false, 0.005, 20), 0); }

}  // namespace
}  // namespace insula
