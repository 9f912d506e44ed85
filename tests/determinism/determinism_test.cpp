// SPDX-License-Identifier: GPL-3.0-or-later
// The same scene and the same hands give the same bits: in a second simulation, with another number of threads, beside
// another simulation, and after reset. (Every plugin's example on its own: tests/physics/contracts_test.cpp.)
#include <gtest/gtest.h>

#include <filesystem>
#include <thread>

#include "core/sim/channel_sum.h"
#include "core/testing/example.h"
#include "tests/determinism/script.h"

namespace insula {
namespace {

namespace fs = std::filesystem;
const fs::path source = INSULA_SOURCE_DIR;

/// Two soft bodies, strands, three tools and contact at once.
std::string everything() {
  return R"(<scene gravity="0 0 -2 m/s2">
  <soft_body id="lower" mesh="meshes/examples/block.msh" mesh_unit="mm"><corotational_fem/>
    <fixed region="beyond" centre="0 0 -19 mm" normal="0 0 -1"/><surface id="lower_surface"/></soft_body>
  <soft_body id="upper" mesh="meshes/examples/block_upper.msh" mesh_unit="mm"><corotational_fem tangent="exact" young="3 kPa"/>
    <fixed region="beyond" centre="0 0 21 mm" normal="0 0 1"/><surface id="upper_surface"/></soft_body>
  <obstacle id="plate"><surface mesh="meshes/examples/plate.obj" mesh_unit="mm" material="bone"/></obstacle>
  <strand_springs from="lower_surface" to="upper_surface" density="15 1/cm2" max_length="6 mm" slack="0.8" strength="0.5 N" cut_length="0.3 mm" reach="1 mm"/>
  <dissector id="knife" model="meshes/instruments/arachnoid_knife/arachnoid_knife.urdf" hand="right" home="9 1 1 mm" shaft="1 0 0" flat="0 0 1"/>
  <suction id="tube" model="meshes/instruments/suction/suction.urdf" hand="left" home="-12 1 1 mm" shaft="-1 0 0.1" flat="0 0 1" capture="4 mm"/>
  <retractor id="arm" model="meshes/instruments/retractor/retractor.urdf" hand="none" home="0 -9 1 mm" shaft="0 -1 0" flat="0 0 1"/>
  <contact between="lower upper plate" friction="0.3"/>
  <contact between="knife tube arm lower upper" friction="0.2"/>
</scene>)";
}

std::vector<std::uint64_t> run(Simulation& s, int steps) {
  std::vector<std::uint64_t> out;
  for (int i = 0; i < steps; ++i) {
    script_hands(s);
    s.step();
    out.push_back(s.state_hash());
  }
  return out;
}

std::unique_ptr<Simulation> scene(int threads) {
  return test::load_text(everything(), source / "determinism.xml", threads);
}

TEST(Determinism, SceneShowsWhatItShould) {
  auto s = scene(1);
  ASSERT_TRUE(s);
  std::size_t contacts = 0, max_rows = 0;
  int cut = 0;
  for (int i = 0; i < 240; ++i) {
    run(*s, 1);
    contacts += s->report().contacts.size();
    max_rows = std::max(max_rows, std::size_t(s->problem().rows));
    cut = int(channel_sum(*s, "total") - channel_sum(*s, "standing"));
    ASSERT_TRUE(s->report().finite);
  }
  EXPECT_GT(contacts, 100u);
  EXPECT_GT(max_rows, 20u);
  EXPECT_GT(cut, 0);
}

TEST(Determinism, ASecondRunGivesTheSameBits) {
  auto a = scene(1), b = scene(1);
  ASSERT_TRUE(a && b);
  const auto x = run(*a, 240), y = run(*b, 240);
  EXPECT_EQ(x, y);
  EXPECT_NE(x[100], x[101]) << "a hash that never changes shows nothing";
}

TEST(Determinism, ThreadsDoNotMatter) {
  auto one = scene(1);
  ASSERT_TRUE(one);
  const auto expected = run(*one, 120);
  for (const int threads : {2, 4}) {
    auto many = scene(threads);
    ASSERT_TRUE(many);
    EXPECT_EQ(many->workers().threads(), threads);
    EXPECT_EQ(run(*many, 120), expected) << threads << " threads";
  }
}

TEST(Determinism, ResetLeadsBackToTheSameBits) {
  auto s = scene(2);
  ASSERT_TRUE(s);
  const auto start = s->state_hash();
  const auto whole = run(*s, 120);
  for (const int before : {1, 37, 120}) {
    s->reset();
    EXPECT_EQ(s->state_hash(), start);
    run(*s, before);
    s->reset();
    EXPECT_EQ(run(*s, 120), whole) << "after a reset at step " << before;
  }
}

// Friction remembers the length of steps, so settling has its own.
TEST(Determinism, AnExerciseBeginsInTheSamePositionAtAnyLengthOfItsSteps) {
  const auto settled = [](const std::string& time_step, const std::string& settle) {
    std::string xml = everything();
    xml.replace(0, std::string("<scene").size(), "<scene time_step=\"" + time_step + "\"");
    xml.insert(xml.find('\n'), "<settle time=\"0.25 s\"" + settle + "/>");
    return test::load_text(xml, source / "settled.xml", 1);
  };
  const auto state = [](const Simulation& s) {
    std::vector<double> x;
    for (const char* id : {"lower", "upper", "arm"}) s.scene().find_as<DynamicBody>(id)->append_state(x);
    return x;
  };
  const auto ten = settled("10 ms", ""), four = settled("4 ms", ""), own = settled("4 ms", " time_step=\"5 ms\"");
  ASSERT_TRUE(ten && four && own);
  EXPECT_EQ(state(*ten), state(*four));
  EXPECT_NE(state(*own), state(*four));
  // Their own steps have the length that was asked for.
  four->step();
  EXPECT_DOUBLE_EQ(four->time(), 0.004);
  four->reset();
  EXPECT_EQ(state(*ten), state(*four));
}

TEST(Determinism, TwoSimulationsInOneProgramDoNotMeet) {
  auto alone = scene(1);
  ASSERT_TRUE(alone);
  const auto expected = run(*alone, 120);
  auto a = scene(2), b = scene(2);
  ASSERT_TRUE(a && b);
  std::vector<std::uint64_t> x, y;
  std::thread other([&] { y = run(*b, 120); });
  x = run(*a, 120);
  other.join();
  EXPECT_EQ(x, expected);
  EXPECT_EQ(y, expected);
}

// Where a component stands among those it has nothing to do with does not matter: two blocks, written in either order.
TEST(Determinism, UnrelatedComponentsDoNotMatter) {
  const std::string block = R"(<soft_body id="block" mesh="meshes/examples/block.msh" mesh_unit="mm"><corotational_fem/>
    <fixed region="beyond" centre="0 0 -19 mm" normal="0 0 -1"/></soft_body>)";
  const std::string other =
      R"(<soft_body id="other" mesh="meshes/examples/block_upper.msh" mesh_unit="mm"><corotational_fem young="4 kPa"/>
    <fixed region="beyond" centre="0 0 21 mm" normal="0 0 1"/></soft_body>)";
  auto one = test::load_text("<scene gravity=\"1 0 -9.81 m/s2\">" + block + other + "</scene>", source / "a.xml", 2);
  auto two = test::load_text("<scene gravity=\"1 0 -9.81 m/s2\">" + other + block + "</scene>", source / "a.xml", 2);
  ASSERT_TRUE(one && two);
  for (int i = 0; i < 60; ++i) {
    one->step();
    two->step();
  }
  for (const char* id : {"block", "other"}) {
    std::vector<double> x, y;
    one->scene().find_as<DynamicBody>(id)->append_state(x);
    two->scene().find_as<DynamicBody>(id)->append_state(y);
    EXPECT_EQ(x, y) << id;
  }
}

class ScenesOf : public testing::TestWithParam<const char*> {};
INSTANTIATE_TEST_SUITE_P(Determinism, ScenesOf, testing::Values("training", "skills"),
                         [](const auto& one) { return std::string(one.param); });

TEST_P(ScenesOf, WithTheirMotions) {
  const fs::path folder = source / "scenes" / GetParam();
  if (!fs::is_directory(folder)) GTEST_SKIP() << "no " << folder;
  for (const auto& entry : fs::directory_iterator(folder)) {
    if (entry.path().extension() != ".xml") continue;
    auto one = test::load(entry.path(), 1), two = test::load(entry.path(), 2);
    ASSERT_TRUE(one && two) << entry.path();
    const auto x = run(*one, 30);
    EXPECT_EQ(x, run(*two, 30)) << entry.path();
    one->reset();
    EXPECT_EQ(x, run(*one, 30)) << entry.path() << " after reset";
  }
}

}  // namespace
}  // namespace insula
