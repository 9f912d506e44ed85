// SPDX-License-Identifier: GPL-3.0-or-later
// Tool exchange in mid-run: from a motion's commands, and what the hand feels of it.
#include <gtest/gtest.h>

#include "core/testing/block_mesh.h"
#include "core/testing/example.h"
#include "engine/live/headless.h"
#include "haptic_server/devices/make_device.h"

namespace insula {
namespace {

// A block under two probes of the right hand: the thin one ends above the skin, the thick one would be in it.
class Exchange : public testing::Test {
 protected:
  void SetUp() override {
    scene_.write("meshes/block.msh",
                 test::gmsh_text(test::block_mesh({4, 4, 2}, {-0.02, -0.02, -0.02}, {0.02, 0.02, 0})));
    for (const auto& [name, radius] : {std::pair{"thin", 0.0005}, std::pair{"thick", 0.003}}) {
      scene_.write(std::string("meshes/") + name + "/probe.urdf", test::test_tool_urdf(radius));
      scene_.write(std::string("meshes/") + name + "/tool.json", test::test_tool_json(0, 0));
    }
    simulation_ = test::load_text(R"(<scene>
  <soft_body id="block" mesh="meshes/block.msh" mesh_unit="m"><corotational_fem young="200 kPa"/><fixed region="beyond" centre="0 0 -19 mm" normal="0 0 -1"/>
    <surface id="skin"/></soft_body>
  <retractor id="thin" hand="right" model="meshes/thin/probe.urdf" home="0 0 20 mm" shaft="0 0 1" flat="1 0 0"/>
  <retractor id="thick" hand="right" model="meshes/thick/probe.urdf" home="0 0 20 mm" shaft="0 0 1" flat="1 0 0" coupling="2000 N/m"/>
  <contact between="thin thick block"/>
</scene>)",
                                  scene_.path() / "scene.xml");
    ASSERT_TRUE(simulation_);
  }
  static Motion hover(const std::string& commands) {
    return parse_motion(
        "time_s,hand,px_m,py_m,pz_m,qw,qx,qy,qz,button1,button2\n"
        "0,right,0,0,0.02,1,0,0,0,0,0\n0.4,right,0,0,0.001,1,0,0,0,0,0\n3,right,0,0,0.001,1,0,0,0,0,0\n" +
            commands,
        "m.csv");
  }
  test::SceneFolder scene_;
  std::unique_ptr<Simulation> simulation_;
};

TEST_F(Exchange, AMotionsCommandsComeAtTheirTimes) {
  HeadlessRun run(
      *simulation_,
      hover("1,command,exchange,right thick\n2,command,message,well done\n2,command,exchange,right thumb\n"));
  for (int round = 0; round < 2; ++round) {
    std::vector<Event> events;
    while (simulation_->time() < 2.5) {
      const double start = simulation_->time();
      run.step();
      EXPECT_EQ(simulation_->instrument_of(1)->id, start >= 1 - 1e-9 ? "thick" : "thin") << start;
      events.insert(events.end(), simulation_->events().begin(), simulation_->events().end());
    }
    ASSERT_EQ(events.size(), 3u);
    EXPECT_EQ(events[0].kind, "command");
    EXPECT_EQ(events[0].text, "right thick");
    EXPECT_EQ(events[1].kind, "message");
    EXPECT_EQ(events[1].text, "well done");
    EXPECT_EQ(events[2].kind, "refused");
    EXPECT_NE(events[2].text.find("no tool \"thumb\" for the right hand"), std::string::npos);
    run.reset();
    EXPECT_EQ(simulation_->instrument_of(1)->id, "thin");
  }
}

struct RenderedForce {
  double largest_slew = 0;   ///< N/s from tick to tick
  double largest_force = 0;  ///< N, after the exchange
  double silent = 0;         ///< s without any force after it
};

RenderedForce rendered_force(Simulation& simulation, const Motion& motion, bool with_pause) {
  simulation.reset();
  InProcessHaptics haptics(motion, {});
  ExchangePause pause;
  Vec3 last = Vec3::Zero();
  RenderedForce rendered;
  double exchanged = -1, before = -1e-3;
  for (int step = 0; step < 180; ++step) {
    if (step == 60) {
      EXPECT_EQ(simulation.command("exchange", "right thick"), "");
      exchanged = simulation.time();
    }
    for (int k = 1; k <= 17; ++k) {
      haptics.tick(simulation.time() + k * simulation.h() / 17);
      const Vec3 f = haptics.hand(1).force;
      rendered.largest_slew = std::max(rendered.largest_slew, (f - last).norm() / (haptics.time() - before));
      last = f;
      before = haptics.time();
      if (exchanged < 0) continue;
      rendered.largest_force = std::max(rendered.largest_force, f.norm());
      if (rendered.largest_force == 0) rendered.silent = haptics.time() - exchanged;
    }
    simulation.set_hand(1, {true, haptics.hand(1).device, false, false});
    simulation.step();
    haptics.set_problem(simulation.problem(), with_pause ? pause.hands(simulation) : std::array<bool, 2>{});
  }
  return rendered;
}

// The thick tool appears two millimetres deep in the block. The hand must feel nothing at first, then the push, never
// faster than its device allows; without the pause it feels the push at once.
TEST_F(Exchange, TheHandFeelsTheNewToolGently) {
  const double limit = simulated_arm(1).profile.max_slew_N_s;
  const RenderedForce bare = rendered_force(*simulation_, hover(""), false),
                      gentle = rendered_force(*simulation_, hover(""), true);
  EXPECT_GT(gentle.largest_force, 0.3) << "the thick tool must press, or nothing is tested";
  EXPECT_LE(bare.largest_slew, limit * (1 + 1e-9));  // the gate's promise
  EXPECT_LE(gentle.largest_slew, limit * (1 + 1e-9));
  EXPECT_LT(bare.silent, 0.02);
  EXPECT_GE(gentle.silent, 0.05);
  EXPECT_LE(gentle.silent, 0.15);
  EXPECT_LT(gentle.largest_slew, 0.8 * bare.largest_slew);
}

}  // namespace
}  // namespace insula
