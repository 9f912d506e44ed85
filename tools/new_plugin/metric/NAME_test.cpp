// SPDX-License-Identifier: GPL-3.0-or-later
// The values of a made motion are those of its closed form.
#include <gtest/gtest.h>

#include <cmath>

#include "core/testing/block_mesh.h"
#include "core/testing/example.h"

namespace insula {
namespace {

double metric(Simulation& s, const std::string& id, int hand) {
  for (const MetricValue& v : s.exercise()->metrics())
    if (v.id == id && v.hand == hand) return v.known ? v.value : std::nan("");
  ADD_FAILURE() << "no metric " << id;
  return 0;
}

TEST(@Name@, IsTheTimeAndTheMeanDistanceNearThePlace) {
  const test::SceneFolder folder;
  folder.write("meshes/pen.urdf", test::test_tool_urdf(0.001));
  folder.write("meshes/tool.json", test::test_tool_json(0, 0));
  auto s = test::load_text(R"(<scene time_step="20 ms">
  <dissector id="probe" model="meshes/pen.urdf" hand="right" home="0 0 0 mm" shaft="0 0 1" flat="1 0 0" sharp="never"/>
  <exercise id="e" title="t"><@name@ id="steady" at="10 0 0 mm" distance="2 mm"/></exercise></scene>)",
                           folder.path() / "scene.xml");
  ASSERT_TRUE(s && s->exercise());
  HandState hand;
  hand.present = true;
  hand.device = s->instrument_of(1)->home_pose();
  for (const double x : {0.0, 0.0095, 0.0115, 0.02}) {  // far, 0.5 mm, 1.5 mm, far
    hand.device.p.x() = x;
    s->set_hand(1, hand);
    for (int i = 0; i < 5; ++i) s->step();
  }
  EXPECT_NEAR(metric(*s, "@name@_time", right_hand), 0.2, 1e-9);
  EXPECT_NEAR(metric(*s, "@name@_distance", right_hand), 1, 1e-6);  // mm
  EXPECT_EQ(metric(*s, "@name@_time", left_hand), 0);
  EXPECT_TRUE(std::isnan(metric(*s, "@name@_distance", left_hand)));
}

}  // namespace
}  // namespace insula
