// SPDX-License-Identifier: GPL-3.0-or-later
// The rate of a session's steps: as given, or the highest that fits; frames come at their own rate.
#include "engine/live/step_rate.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <filesystem>

#include "core/base/input_error.h"
#include "core/bus/channels.h"
#include "core/bus/codec.h"
#include "core/bus/mem_bus.h"
#include "core/haptics/haptic_update.h"
#include "core/testing/block_mesh.h"
#include "core/testing/example.h"
#include "core/testing/temp_folder.h"
#include "engine/live/headless.h"
#include "engine/live/live_engine.h"

namespace insula {
namespace {

namespace fs = std::filesystem;

TEST(StepRate, IsANumberInRangeOrAutomatic) {
  EXPECT_EQ(read_step_rate("").hz, 0);
  EXPECT_FALSE(read_step_rate("").automatic);
  EXPECT_EQ(read_step_rate("120").hz, 120);
  EXPECT_EQ(read_step_rate("0.24 kHz").hz, 240);
  EXPECT_TRUE(read_step_rate("auto").automatic);
  for (const char* wrong : {"automatic", "5 Hz", "2 kHz", "10 ms", "-60", "nan"})
    EXPECT_THROW(read_step_rate(wrong), InputError) << wrong;
}

TEST(StepRate, IsTheHighestWhosePeriodHoldsAStepWithItsMargin) {
  for (std::size_t i = 0; i < automatic_rates_hz.size(); ++i) {
    const double hz = automatic_rates_hz[i], allowed_ms = trial_share * 1000 / hz;
    EXPECT_EQ(highest_rate_hz(0.999 * allowed_ms), hz);
    const double next = automatic_rates_hz[std::min(i + 1, automatic_rates_hz.size() - 1)];
    EXPECT_EQ(highest_rate_hz(1.001 * allowed_ms), next);
  }
  EXPECT_EQ(highest_rate_hz(1e6), automatic_rates_hz.back());
}

/// A block that the right hand's motion presses.
class LoadedAtRate : public testing::Test {
 protected:
  void SetUp() override {
    scene_.write("meshes/block.msh",
                 test::gmsh_text(test::block_mesh({4, 4, 2}, {-0.02, -0.02, -0.02}, {0.02, 0.02, 0})));
    scene_.write("meshes/probe/probe.urdf", test::test_tool_urdf(0.002));
    scene_.write("meshes/probe/tool.json", test::test_tool_json(0, 0));
    scene_.write("press.csv",
                 "time_s,hand,px_m,py_m,pz_m,qw,qx,qy,qz,button1,button2\n"
                 "0,right,0,0,0.02,1,0,0,0,0,0\n0.2,right,0,0,-0.002,1,0,0,0,0,0\n1,right,0,0,-0.002,1,0,0,0,0,0\n");
    scene_.write("scene.xml", R"(<scene time_step="10 ms">
  <soft_body id="block" mesh="meshes/block.msh" mesh_unit="m"><corotational_fem young="20 kPa"/>
    <fixed region="beyond" centre="0 0 -19 mm" normal="0 0 -1"/><surface id="skin"/></soft_body>
  <retractor id="probe" hand="right" model="meshes/probe/probe.urdf" home="0 0 20 mm" shaft="0 0 1" flat="1 0 0"/>
  <contact between="probe block"/>
  <exercise id="e" title="E"><motion id="steady" file="press.csv"/></exercise>
</scene>)");
  }
  fs::path scene() const { return scene_.path() / "scene.xml"; }
  std::unique_ptr<Simulation> load(const std::string& rate, std::string* said = nullptr) {
    std::string text;
    SimulationResult loaded = load_at_rate(scene(), test::builtin(), 1, read_step_rate(rate), text);
    EXPECT_EQ(loaded.diagnostics.format(), "");
    if (said) *said = text;
    return std::move(loaded.simulation);
  }
  std::uint64_t hash_after_pressing(Simulation& simulation) {
    HeadlessRun run(simulation, load_motion(scene_.path() / "press.csv"));
    while (simulation.time() < 0.3) run.step();
    EXPECT_FALSE(simulation.report().contacts.empty());
    return simulation.state_hash();
  }
  test::SceneFolder scene_;
};

TEST_F(LoadedAtRate, StepsAreAsLongAsWanted) {
  std::string said;
  EXPECT_DOUBLE_EQ(load("", &said)->h(), 0.01);
  EXPECT_EQ(said, "");
  EXPECT_NEAR(load("240 Hz", &said)->h(), 1.0 / 240, 1e-11);
  EXPECT_EQ(said, "");
}

TEST_F(LoadedAtRate, ATrialLeavesNoTrace) {
  std::string said;
  const auto tried = load("auto", &said);
  const double hz = std::round(1 / tried->h());
  EXPECT_NE(std::find(automatic_rates_hz.begin(), automatic_rates_hz.end(), hz), automatic_rates_hz.end()) << hz;
  EXPECT_TRUE(said.starts_with(std::to_string(int(hz)) + " steps a second: ")) << said;
  EXPECT_EQ(tried->time(), 0);
  const auto fresh = load(std::to_string(int(hz)));
  EXPECT_EQ(tried->h(), fresh->h());
  EXPECT_EQ(hash_after_pressing(*tried), hash_after_pressing(*fresh));
}

TEST_F(LoadedAtRate, EachStepHasAProblemAndFramesComeAt60Hz) {
  MemBus bus;
  int problems = 0;
  std::vector<double> frames_s;
  bus.subscribe(channel::haptic_problem, [&](Bytes) { ++problems; });
  bus.subscribe(channel::render_frame, [&](Bytes bytes) {
    insula_lcm::render_frame_t m{};
    std::string why;
    ASSERT_TRUE(decode(bytes, m, why)) << why;
    frames_s.push_back(m.sim_time_s);
  });
  LiveOptions options;
  options.scene = scene();
  options.motion = "none";
  options.bundle_root = scene_.path() / "bundle";
  options.duration = 1;
  options.rate = {240, false};
  options.unthrottled = true;
  options.threads = 1;
  const std::atomic<bool> stop{false};
  ASSERT_EQ(run_live(options, test::builtin(), bus, stop), 0);
  EXPECT_NEAR(problems, 240, 1);
  ASSERT_NEAR(double(frames_s.size()), 60, 1);
  for (std::size_t k = 1; k < frames_s.size(); ++k) EXPECT_NEAR(frames_s[k] - frames_s[k - 1], 1.0 / 60, 1e-9);
}

}  // namespace
}  // namespace insula
