// SPDX-License-Identifier: GPL-3.0-or-later
// The scene bundle: its files have the announced sizes and say what the simulation says.
#include "engine/live/bundle.h"

#include <gtest/gtest.h>

#include <cstring>
#include <fstream>
#include <iterator>
#include <map>
#include <nlohmann/json.hpp>

#include "core/base/input_error.h"
#include "core/mechanics/soft_body.h"
#include "core/testing/block_mesh.h"
#include "core/testing/example.h"
#include "engine/live/frame.h"

namespace insula {
namespace {

using Json = nlohmann::json;

class BundleOfAScene : public testing::Test {
 protected:
  void SetUp() override {
    scene_.write("meshes/low.msh",
                 test::gmsh_text(test::block_mesh({3, 3, 2}, {-0.01, -0.01, -0.01}, {0.01, 0.01, -0.001})));
    scene_.write("meshes/high.msh",
                 test::gmsh_text(test::block_mesh({2, 2, 2}, {-0.01, -0.01, 0.001}, {0.01, 0.01, 0.01})));
    TriMesh floor;
    floor.vertices = {{-0.02, -0.02, -0.012}, {0.02, -0.02, -0.012}, {0, 0.02, -0.012}};
    floor.triangles = {{0, 1, 2}};
    scene_.write("meshes/floor.obj", test::obj_text(floor));
    scene_.write("meshes/tool/probe.urdf", test::test_tool_urdf(0.001));
    scene_.write("meshes/tool/tool.json", test::test_tool_json(0.001, 0));
    simulation_ = test::load_text(R"(<scene title="Two &lt;blocks&gt;">
  <soft_body id="low" mesh="meshes/low.msh" mesh_unit="m"><corotational_fem/><fixed region="beyond" centre="0 0 -9 mm" normal="0 0 -1"/>
    <surface id="low_surface" material="cortex"/></soft_body>
  <obstacle id="floor"><surface id="floor_surface" mesh="meshes/floor.obj" mesh_unit="m" material="bone"/></obstacle>
  <soft_body id="high" mesh="meshes/high.msh" mesh_unit="m"><corotational_fem/><fixed region="beyond" centre="0 0 9 mm" normal="0 0 1"/>
    <surface id="high_surface" material="pia"/></soft_body>
  <dissector id="knife" hand="right" model="meshes/tool/probe.urdf" home="0 0 30 mm" shaft="0 0 1" flat="1 0 0"/>
  <strand_springs id="fibres" from="low_surface" to="high_surface" density="20 1/cm2" max_length="4 mm"/>
  <brain_relaxation id="brain" on="low"/>
  <view eye="100 0 0 mm" target="0 0 0 mm" up="0 0 1" field_of_view="25 deg"/>
  <exercise id="task" title="A task" text="Do it"><goal_strands id="all" text="Divide all"/></exercise>
</scene>)",
                                  scene_.path() / "scene.xml");
    ASSERT_TRUE(simulation_);
  }

  Json written() {
    write_bundle(*simulation_, dir_, 42);
    std::ifstream in(dir_ / "scene.json");
    return Json::parse(in);
  }
  template <class T>
  std::vector<T> values(const Json& name) const {
    std::ifstream in(dir_ / name.get<std::string>(), std::ios::binary);
    const std::string bytes{std::istreambuf_iterator<char>(in), {}};
    std::vector<T> out(bytes.size() / 4);
    std::memcpy(out.data(), bytes.data(), 4 * out.size());
    return out;
  }
  void check_mesh(const Json& m) const {
    const auto positions = values<float>(m.at("positions"));
    const auto indices = values<std::uint32_t>(m.at("indices"));
    EXPECT_EQ(positions.size(), 3 * m.at("vertices").get<std::size_t>());
    EXPECT_EQ(indices.size(), 3 * m.at("triangles").get<std::size_t>());
    EXPECT_FALSE(indices.empty());
    for (std::uint32_t i : indices) EXPECT_LT(i, m.at("vertices").get<std::uint32_t>());
  }

  test::SceneFolder scene_;
  std::filesystem::path dir_ = scene_.path() / "bundle" / "deep";
  std::unique_ptr<Simulation> simulation_;
};

TEST_F(BundleOfAScene, NamesWhatTheSceneHolds) {
  const Json j = written();
  EXPECT_EQ(j.at("version"), 3);
  EXPECT_EQ(j.at("session"), 42);
  EXPECT_EQ(j.at("title"), "Two <blocks>");
  EXPECT_NEAR(j.at("view").at("fov_deg").get<double>(), 25, 1e-12);
  EXPECT_NEAR(j.at("view").at("eye").at(0).get<double>(), 0.1, 1e-15);
  ASSERT_EQ(j.at("bodies").size(), 2u);
  EXPECT_EQ(j.at("bodies").at(0).at("id"), "low");
  EXPECT_EQ(j.at("bodies").at(1).at("id"), "high");  // an obstacle in between takes no number
  EXPECT_EQ(j.at("bodies").at(1).at("index"), 1);
  ASSERT_EQ(j.at("static").size(), 1u);
  EXPECT_EQ(j.at("static").at(0).at("material"), "bone");
  check_mesh(j.at("static").at(0));
  simulation_->step();
  const Json& fibres = j.at("drawables").at(0);
  EXPECT_EQ(fibres.at("kind"), "polylines");
  EXPECT_EQ(double(fibres.at("count")), simulation_->channel(fibres.at("component").get<std::string>() + ".total"));
  EXPECT_GT(fibres.at("count"), 0);
  EXPECT_EQ(j.at("materials").at(fibres.at("material").get<std::string>()).at("style"), "fibre");
  ASSERT_EQ(j.at("channels").size(), simulation_->channels().entries().size());
  std::size_t next = 0;
  for (const Json& c : j.at("channels")) {
    EXPECT_EQ(c.at("offset"), next) << c.at("id");
    next += c.at("size").get<std::size_t>();
  }
  EXPECT_EQ(next, simulation_->report().channels.size());
  EXPECT_EQ(j.at("exercise").at("id"), "task");
  EXPECT_EQ(j.at("exercise").at("goals").at(0).at("text"), "Divide all");
  EXPECT_FALSE(std::filesystem::exists(dir_ / "scene.json.part"));
}

TEST_F(BundleOfAScene, AnEdgeThatIsMadeBluntCutsNothing) {
  const std::string pose =
      R"( hand="right" model="meshes/tool/probe.urdf" home="0 0 0 mm" shaft="0 0 1" flat="1 0 0"/>)";
  simulation_ = test::load_text("<scene><dissector id=\"knife\"" + pose + "<dissector id=\"blunt\" sharp=\"never\"" +
                                    pose + "<dissector id=\"button\" sharp=\"button\"" + pose + "</scene>",
                                scene_.path() / "tools.xml");
  ASSERT_TRUE(simulation_);
  std::map<std::string, bool> cuts;
  const Json j = written();
  for (const Json& tool : j.at("tools")) cuts[tool.at("id")] = tool.at("cuts");
  EXPECT_EQ(cuts, (std::map<std::string, bool>{{"blunt", false}, {"button", true}, {"knife", true}}));
}

TEST_F(BundleOfAScene, SkinsFollowTheNodes) {
  const Json j = written();
  for (const Json& body : j.at("bodies")) {
    const auto rest = values<float>(body.at("rest"));
    ASSERT_EQ(rest.size(), 3 * body.at("nodes").get<std::size_t>());
    ASSERT_EQ(body.at("surfaces").size(), 1u);
    const Json& s = body.at("surfaces").at(0);
    check_mesh(s);
    const auto nodes = values<std::uint32_t>(s.at("skin_nodes"));
    const auto weights = values<float>(s.at("skin_weights"));
    const auto positions = values<float>(s.at("positions"));
    const std::size_t vertices = s.at("vertices");
    ASSERT_EQ(nodes.size(), 4 * vertices);
    ASSERT_EQ(weights.size(), 4 * vertices);
    for (std::size_t v = 0; v < vertices; ++v) {
      double sum = 0;
      Vec3 at = Vec3::Zero();
      for (std::size_t k = 4 * v; k < 4 * v + 4; ++k) {
        ASSERT_LT(nodes[k], body.at("nodes").get<std::uint32_t>());
        sum += double(weights[k]);
        for (int c = 0; c < 3; ++c) at[c] += double(weights[k]) * double(rest[3 * nodes[k] + std::size_t(c)]);
      }
      EXPECT_NEAR(sum, 1, 1e-6);
      EXPECT_LT(
          (at - Vec3(double(positions[3 * v]), double(positions[3 * v + 1]), double(positions[3 * v + 2]))).norm(),
          1e-8);
    }
  }
}

TEST_F(BundleOfAScene, ToolsStandAtHome) {
  const Json j = written();
  ASSERT_EQ(j.at("tools").size(), 1u);
  EXPECT_EQ(j.at("tools").at(0).at("hand"), "right");
  EXPECT_EQ(j.at("tools").at(0).at("kind"), "dissector");
  for (const Json& part : j.at("tools").at(0).at("parts")) check_mesh(part);
  const Json& hand = j.at("hands").at(0);
  EXPECT_EQ(hand.at("tool"), 0);
  const Pose home = simulation_->instruments()[0]->home_pose();
  for (int k = 0; k < 3; ++k) EXPECT_EQ(hand.at("home_p_m").at(std::size_t(k)), home.p[k]);
  EXPECT_EQ(hand.at("home_q").at(0), home.q.w());
}

TEST_F(BundleOfAScene, AHandHasAllItsToolsAndAnArmNone) {
  simulation_ = test::load_text(R"(<scene>
  <retractor id="arm" hand="none" model="meshes/tool/probe.urdf" home="0 0 30 mm" shaft="0 0 1" flat="1 0 0"/>
  <dissector id="first" hand="right" model="meshes/tool/probe.urdf" home="0 0 10 mm" shaft="0 0 1" flat="1 0 0"/>
  <retractor id="other" hand="left" model="meshes/tool/probe.urdf" home="0 0 30 mm" shaft="0 0 1" flat="1 0 0"/>
  <dissector id="second" hand="right" model="meshes/tool/probe.urdf" home="0 0 20 mm" shaft="0 0 1" flat="1 0 0"/>
</scene>)",
                                scene_.path() / "scene.xml");
  ASSERT_TRUE(simulation_);
  const Json j = written();
  ASSERT_EQ(j.at("hands").size(), 2u);
  EXPECT_EQ(j.at("hands").at(0).at("hand"), "left");
  EXPECT_EQ(j.at("hands").at(0).at("tools"), Json({2}));
  EXPECT_EQ(j.at("hands").at(1).at("tools"), Json({1, 3}));
  EXPECT_EQ(j.at("hands").at(1).at("tool"), 1);
  EXPECT_EQ(j.at("hands").at(1).at("home_p_m").at(2), 0.01);
  // In frames: in the hand, on the tray, on its arm.
  simulation_->step();
  EXPECT_EQ(simulation_->command("exchange", "right second"), "");
  simulation_->step();
  insula_lcm::render_frame_t f{};
  fill_frame(*simulation_, f);
  ASSERT_EQ(f.tools, 4);
  const int state[] = {1, 0, 1, 1}, hand[] = {-1, 1, 0, 1};
  for (std::size_t i = 0; i < 4; ++i) {
    EXPECT_EQ(f.tool[i].state, state[i]) << i;
    EXPECT_EQ(f.tool[i].hand, hand[i]) << i;
  }
}

TEST_F(BundleOfAScene, TellsWhatTheSurgeonMayAskFor) {
  const Json bundle = written();
  std::map<std::string, Json> commands;
  for (const Json& group : bundle.at("commands"))
    if (group.at("id") == "brain")
      for (const Json& c : group.at("commands")) commands[c.at("name")] = c;
  EXPECT_EQ(commands.at("give_mannitol").at("usual"), 0) << "it takes no number";
  EXPECT_FALSE(commands.at("swell").contains("usual")) << "nobody asks for a complication";
}

// Shipped geometry: a vessel with its picture surface, and a clip's model in a hand.
TEST_F(BundleOfAScene, TellsOfVesselsAndArticulatedTools) {
  const std::filesystem::path source = INSULA_SOURCE_DIR;
  simulation_ = test::load_text(R"(<scene>
  <shell_body id="artery" wall="../../meshes/arteries/narrow_neck/vessel.json"><fixed/>
    <surface id="wall" material="vessel"/>
    <surface id="picture" mesh="../../meshes/arteries/narrow_neck/picture.ply" mesh_unit="mm" material="vessel" contact="false"/></shell_body>
  <retractor id="clip" hand="right" model="../../meshes/clips/straight/straight.urdf" home="0 0 90 mm" shaft="0 0 1" flat="1 0 0"/>
</scene>)",
                                source / "scenes/training/bundle_test.xml");
  ASSERT_TRUE(simulation_);
  const Json j = written();
  const auto* shell = simulation_->scene().find_as<ShellBody>("artery");
  const Json& body = j.at("bodies").at(0);
  EXPECT_EQ(body.at("nodes"), shell->nodes());
  EXPECT_EQ(body.at("regions"), Json(shell->model().regions));
  EXPECT_TRUE(body.at("region_value").at("channel_of_region").empty()) << "no blood flows in this scene";
  EXPECT_TRUE(body.at("region_value").at("pressure_of_region").empty()) << "nothing presses in this scene";
  ASSERT_EQ(body.at("ends").size(), shell->model().caps.size());
  for (const Json& end : body.at("ends")) {
    EXPECT_NEAR(std::hypot(end.at("outward")[0].get<double>(), end.at("outward")[1].get<double>(),
                           end.at("outward")[2].get<double>()),
                1, 1e-12);
    EXPECT_GT(end.at("radius_m").get<double>(), 0.0005);
    EXPECT_LT(end.at("radius_m").get<double>(), 0.0025);
  }
  ASSERT_EQ(body.at("surfaces").size(), 2u);
  for (std::size_t k = 0; k < 2; ++k) {
    const Json& s = body.at("surfaces").at(k);
    check_mesh(s);
    EXPECT_EQ(s.at("regions"), Json(shell->model().regions));
    const auto region = values<std::uint32_t>(s.at("vertex_region"));
    ASSERT_EQ(region.size(), s.at("vertices").get<std::size_t>());
    const Surface& surface = *simulation_->surfaces()[k];
    // Each vertex has the region of the wall vertex that is nearest among those it follows.
    for (std::size_t v = 0; v < region.size(); ++v) {
      ASSERT_LT(region[v], shell->model().regions.size());
      const MaterialPoint& p = surface.points()[v];
      bool found = false;
      for (int n = 0; n < p.count; ++n)
        found = found || shell->model().vertex_region[std::size_t(p.node[std::size_t(n)])] == int(region[v]);
      ASSERT_TRUE(found) << v;
      if (k == 0) {
        ASSERT_EQ(int(region[v]), shell->model().vertex_region[v]);
      }
    }
  }
  const Json& tool = j.at("tools").at(0);
  const ToolModel& model = simulation_->instruments()[0]->tool();
  ASSERT_EQ(tool.at("hinges").size(), model.hinges.size());
  EXPECT_EQ(model.hinges.size(), 2u);
  EXPECT_EQ(tool.at("hinges").at(1).at("multiplier"), model.hinges[1].multiplier);
  int links = 0;
  for (const Json& part : tool.at("parts")) links = std::max(links, part.at("link").get<int>());
  EXPECT_EQ(links, 2);
  EXPECT_TRUE(tool.at("properties").empty()) << "a retractor tells nothing of its model";
  EXPECT_TRUE(std::filesystem::file_size(dir_ / tool.at("picture").get<std::string>()) > 100);
}

TEST_F(BundleOfAScene, SaysWhenItCannotBeWritten) {
  scene_.write("file", "x");
  EXPECT_THROW(write_bundle(*simulation_, scene_.path() / "file", 1), InputError);
}

}  // namespace
}  // namespace insula
