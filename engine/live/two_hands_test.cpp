// SPDX-License-Identifier: GPL-3.0-or-later
// Two hands in one problem: each feels what the other does within a tick, through tissue, tool on tool, and with a clip
// in the applier.
#include <gtest/gtest.h>

#include <algorithm>

#include "core/testing/block_mesh.h"
#include "core/testing/example.h"
#include "haptic_server/servo.h"

namespace insula {
namespace {

class TwoHands : public testing::TestWithParam<bool> {
 protected:
  void load(const std::string& body, const std::filesystem::path& file) {
    simulation_ = test::load_text("<scene>" + body + "</scene>", file);
    ASSERT_TRUE(simulation_);
    for (int h = 0; h < 2; ++h) hand_[std::size_t(h)] = simulation_->instrument_of(h)->home_pose();
  }
  void load_block(const std::string& tools) {
    scene_.write("meshes/block.msh",
                 test::gmsh_text(test::block_mesh({8, 4, 3}, {-0.02, -0.01, -0.015}, {0.02, 0.01, 0})));
    scene_.write("meshes/probe/probe.urdf", test::test_tool_urdf(0.002));
    scene_.write("meshes/probe/tool.json", test::test_tool_json(0, 0));
    load(
        R"(<soft_body id="lobe" mesh="meshes/block.msh" mesh_unit="m"><corotational_fem/><fixed region="beyond" centre="0 0 -14 mm" normal="0 0 -1"/>
      <surface/></soft_body>)" +
            tools,
        scene_.path() / "scene.xml");
  }
  void load_applier(const std::string& touch) {
    load(
        R"(<soft_body id="lobe" mesh="../meshes/examples/block.msh" mesh_unit="mm"><corotational_fem/><fixed region="beyond" centre="0 0 -19 mm" normal="0 0 -1"/>
        <surface/></soft_body>
      <solver max_sweeps="100" tolerance="1e-9 m" conjugate="true" newton="8"/>
      <clip id="straight" model="../meshes/clips/straight/straight.urdf"/>
      <clip_applier id="applier" model="../meshes/instruments/clip_applier/clip_applier.urdf" hand="right" clips="straight" load="straight" home="6 0 40 mm" shaft="0 0 1" flat="1 0 0"/>
      <retractor id="spatula" model="../meshes/instruments/retractor/retractor.urdf" hand="left" home="-8 0 3 mm" shaft="0 0 1" flat="1 0 0"/>
      <contact between=")" +
            touch + R"(" friction="0.2"/>)",
        std::filesystem::path(INSULA_SOURCE_DIR) / "scenes/two_hands.xml");
  }
  /// Steps with both hands where they are; then the servo has the last problem.
  void step(int n) {
    for (int k = 0; k < n; ++k) {
      for (int h = 0; h < 2; ++h) simulation_->set_hand(h, {true, hand_[std::size_t(h)], false, false});
      simulation_->step();
    }
    problem_ = simulation_->problem();
    servo_.set_problem(nullptr);
    servo_.reset();
    servo_.set_problem(&problem_, {}, 1e-3);
  }
  Vec3 engine_force(int h) const { return simulation_->instrument_of(h)->hand_force().head<3>(); }
  ServoResult tick() {
    ServoInput in;
    in.device = hand_;
    in.connected = {true, true};
    return servo_.tick(in);
  }
  static ServoSettings settings() {
    ServoSettings s;
    if (GetParam())
      s.substep = {
          .substep_compliance = true, .extrapolate_tissue = true, .incremental_slip = true, .eliminate_welds = true};
    return s;
  }

  test::SceneFolder scene_;
  std::unique_ptr<Simulation> simulation_;
  ConstraintProblem problem_;
  Servo servo_{settings()};
  std::array<Pose, 2> hand_;
};

constexpr const char* two_probes = R"(
  <retractor id="left" hand="left" model="meshes/probe/probe.urdf" home="-4 0 4 mm" shaft="0 0 1" flat="1 0 0"/>
  <retractor id="right" hand="right" model="meshes/probe/probe.urdf" home="4 0 4 mm" shaft="0 0 1" flat="1 0 0"/>
  <contact between="left right lobe" friction="0.2"/>)";

TEST_P(TwoHands, AHandAtRestFeelsTheOthersPressThroughTheLobe) {
  load_block(two_probes);
  hand_[0].p.z() = hand_[1].p.z() = 0.5e-3;  // pressed in: the probes' radius is 2 mm
  step(60);
  ServoResult before;
  for (int k = 0; k < 20; ++k) before = tick();
  ASSERT_GT(before.hand[0].force.z(), 5e-3);
  hand_[1].p.z() -= 0.5e-3;
  const ServoResult after = tick();
  // The lobe goes down under the other hand as well: less to lean on, in the very tick.
  EXPECT_GT(after.hand[1].force.z(), before.hand[1].force.z() + 1e-3);
  EXPECT_LT(after.hand[0].force.z(), before.hand[0].force.z() - 1e-5);
  if (!GetParam()) return;
  // And as much in the end as the engine says: in ticks tissue creeps on.
  const Vec3 at_once = before.hand[0].force;
  ServoResult late = after;
  for (int k = 0; k < 200; ++k) late = tick();
  step(30);
  EXPECT_NEAR(late.hand[0].force.z() - at_once.z(), engine_force(0).z() - at_once.z(),
              0.3 * std::abs(engine_force(0).z() - at_once.z()));
}

TEST_P(TwoHands, ToolsThatTouchFeelEachOther) {
  load_block(two_probes);
  hand_[0].p = Vec3(-1.8e-3, 0, 8e-3);  // 0.4 mm into each other, above the lobe
  hand_[1].p = Vec3(1.8e-3, 0, 8e-3);
  step(60);
  for (const double push : {0.0, 0.2e-3, 0.4e-3}) {
    hand_[1].p.x() = 1.8e-3 - push;
    const ServoResult r = tick();
    ASSERT_TRUE(r.hand[0].valid && r.hand[1].valid);
    // Two springs of 300 N/m in a row share the overlap.
    EXPECT_NEAR(r.hand[1].force.x(), 150 * (0.4e-3 + push), 0.02 * 150 * (0.4e-3 + push));
    EXPECT_NEAR((r.hand[0].force + r.hand[1].force).norm(), 0, 1e-6);
  }
}

TEST_P(TwoHands, AnApplierWithItsClipAndARetractorStayCoherent) {
  load_applier("spatula applier straight lobe");
  for (int k = 0; k < 40; ++k) {
    hand_[0].p.z() -= 0.12e-3;
    step(1);
  }
  step(30);
  ASSERT_GT(engine_force(0).norm(), 5e-3);
  ASSERT_EQ(problem_.tools.size(), 2u);
  EXPECT_TRUE(std::any_of(problem_.blocks.begin(), problem_.blocks.end(),
                          [](const Block& b) { return b.lower == -infinite && b.upper == infinite; }));
  // At rest both hands feel what the engine computed; then both move, each with its own: the clip goes with its applier
  // and the other hand feels nothing of it.
  ServoResult r;
  for (int k = 0; k < 50; ++k) r = tick();
  for (int h = 0; h < 2; ++h)
    EXPECT_NEAR((r.hand[std::size_t(h)].force - engine_force(h)).norm(), 0, 0.02 * engine_force(0).norm()) << h;
  for (int k = 0; k < 17; ++k) {
    hand_[0].p.z() -= 5e-6;
    hand_[1].p.z() -= 5e-5;
    const ServoResult next = tick();
    ASSERT_TRUE(next.hand[0].valid && next.hand[1].valid);
    EXPECT_LT((next.hand[0].force - r.hand[0].force).norm(), 300 * 5e-6) << k;
    // Its inertia, not an anchor: less than half of the coupling, or in ticks what the jerk of the start leaves.
    EXPECT_LT(next.hand[1].force.norm(), GetParam() ? 0.045 : 0.5 * 300 * 5e-5 * (k + 1)) << k;
    r = next;
  }
  step(1);
  EXPECT_NEAR((r.hand[0].force - engine_force(0)).norm(), 0, 0.1 * engine_force(0).norm());
}

/// With all of what the haptic server does between steps.
class TwoHandsBetweenSteps : public TwoHands {};

TEST_P(TwoHandsBetweenSteps, AClipPressedIntoTissueBesideARetractor) {
  load_applier("spatula straight lobe");
  const auto press = [&](std::size_t h, double min_N) {
    for (int k = 0; k < 400 && engine_force(int(h)).norm() < min_N; ++k) {
      hand_[h].p.z() -= 0.15e-3;
      step(1);
    }
  };
  press(1, 0.05);
  press(0, 0.03);
  step(300);
  ASSERT_GT(engine_force(0).norm(), 0.01);
  ASSERT_GT(engine_force(1).norm(), 0.03);
  EXPECT_EQ(servo_.problem()->rows, problem_.rows - 6);  // the clip's own six are gone from what is solved
  ServoResult r;
  for (int k = 0; k < 50; ++k) r = tick();
  const double largest = std::max(engine_force(0).norm(), engine_force(1).norm());
  for (int h = 0; h < 2; ++h)
    EXPECT_NEAR((r.hand[std::size_t(h)].force - engine_force(h)).norm(), 0, 0.02 * largest) << h;
  for (int k = 0; k < 17; ++k) {
    hand_[0].p.z() -= 5e-6;
    hand_[1].p.z() -= 2e-5;
    const ServoResult next = tick();
    EXPECT_LT(next.stats.residual_m, 1e-6) << k;
    for (std::size_t h = 0; h < 2; ++h) {
      ASSERT_TRUE(next.hand[h].valid);
      EXPECT_LT((next.hand[h].force - r.hand[h].force).norm(), 300 * 2e-5) << k << ' ' << h;
    }
    r = next;
  }
  // And where both have come to rest the engine says the same.
  for (int k = 0; k < 300; ++k) r = tick();
  step(60);
  for (int h = 0; h < 2; ++h)
    EXPECT_NEAR((r.hand[std::size_t(h)].force - engine_force(h)).norm(), 0, 0.1 * largest) << h;
}

INSTANTIATE_TEST_SUITE_P(Servo, TwoHandsBetweenSteps, testing::Values(true), [](const auto&) { return "in_ticks"; });
INSTANTIATE_TEST_SUITE_P(Servo, TwoHands, testing::Bool(),
                         [](const auto& about) { return about.param ? "in_ticks" : "equation_7"; });

}  // namespace
}  // namespace insula
