// SPDX-License-Identifier: GPL-3.0-or-later
// When a dissector cuts, and what it says about a tool without an edge. Forces of cutting: strand_springs_test.cpp.
#include <gtest/gtest.h>

#include "core/testing/block_mesh.h"
#include "core/testing/example.h"

namespace insula {
namespace {

std::string scene(const std::string& sharp, const std::string& tool) {
  return "<scene><dissector id=\"d\" model=\"meshes/" + tool +
         "/tool.urdf\" hand=\"right\" home=\"0 0 0 m\" shaft=\"0 0 1\" flat=\"1 0 0\" sharp=\"" + sharp +
         "\"/></scene>";
}

class DissectorTest : public ::testing::Test {
 protected:
  DissectorTest() {
    folder_.write("meshes/edged/tool.urdf", test::test_tool_urdf(0.0005));
    folder_.write("meshes/edged/tool.json", test::test_tool_json(0.002, 0));
    folder_.write("meshes/round/tool.urdf", test::test_tool_urdf(0.0005));
  }
  test::SceneFolder folder_;
};

TEST_F(DissectorTest, CutsWhenItsSharpnessSays) {
  for (const auto& [sharp, without, with] :
       {std::tuple{"always", true, true}, {"button", false, true}, {"never", false, false}}) {
    auto s = test::load_text(scene(sharp, "edged"), folder_.path() / "d.xml");
    ASSERT_TRUE(s);
    auto* d = s->scene().find_as<Instrument>("d");
    HandState hand;
    hand.present = true;
    hand.device = d->home_pose();
    s->set_hand(1, hand);
    EXPECT_EQ(d->cutting(), without) << sharp;
    hand.button1 = true;
    s->set_hand(1, hand);
    EXPECT_EQ(d->cutting(), with) << sharp;
    EXPECT_EQ(d->activity(), std::string(sharp) == "button" ? 1 : 0);
    s->reset();
    EXPECT_EQ(d->cutting(), without) << sharp << ": reset must forget the button";
  }
}

TEST_F(DissectorTest, AToolWithoutAnEdgeMustBeDeclaredBlunt) {
  for (const char* sharp : {"always", "button"}) {
    const auto result = load_simulation_text(scene(sharp, "round"), folder_.path() / "d.xml", test::builtin(), 1);
    EXPECT_FALSE(result.simulation);
    EXPECT_NE(result.diagnostics.format().find("no cutting edge"), std::string::npos) << result.diagnostics.format();
  }
  auto s = test::load_text(scene("never", "round"), folder_.path() / "d.xml");
  ASSERT_TRUE(s);
  EXPECT_FALSE(s->scene().find_as<Instrument>("d")->cutting());
}

TEST_F(DissectorTest, ShippedToolsHaveEdges) {
  auto s = test::load(std::filesystem::path(INSULA_SOURCE_DIR) / "plugins/dissector/example.xml");
  ASSERT_TRUE(s);
  EXPECT_FALSE(s->instruments().front()->tool().blade_edges.empty());
}

}  // namespace
}  // namespace insula
