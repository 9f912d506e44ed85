// SPDX-License-Identifier: GPL-3.0-or-later
// A blade drawn through a strand between two fixed points: when the hand feels that it parts, at 60 Hz and at 1 kHz.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include "core/testing/block_mesh.h"
#include "core/testing/example.h"
#include "plugins/strand_springs/strand_springs.h"
#include "tools/workbench/haptic_truth.h"

namespace insula {
namespace {

constexpr double cut_force = 0.045, duration = 0.4;

struct Bed {
  test::SceneFolder folder;
  std::unique_ptr<Simulation> s;
  Bed(double rate, const char* cut_length) {
    folder.write("meshes/knife/knife.urdf", test::test_tool_urdf(0.0005));
    folder.write("meshes/knife/tool.json", test::test_tool_json(0.003, 0));
    s = test::load_text(fmt::format(R"(<scene time_step="{} s"><obstacle id="wall"/>
  <dissector id="knife" model="meshes/knife/knife.urdf" hand="right" home="1 0 5 mm" shaft="1 0 0" flat="0 0 1" coupling="300 N/m" sharp="always"/>
  <strand_springs id="strands" stiffness="30 N/m" slack="0.9" cut_force="0.045 N" cut_length="{}" reach="0.5 mm"/></scene>)",
                                    1 / rate, cut_length),
                        folder.path() / "scene.xml");
    if (!s) return;
    auto* strands = s->scene().find_as<StrandSprings>("strands");
    MaterialPoint a;
    a.body = s->scene().find_as<Body>("wall");
    MaterialPoint b = a;
    b.local = Vec3(0, 0, 0.01);
    strands->add_strand(a, b);
  }
};

/// The hand waits, and then moves along -x at 7 mm/s.
Motion drawn(const Simulation& s) {
  Motion m;
  HandSample hand;
  hand.pose = s.instrument_of(1)->home_pose();
  m.add(1, {0, hand});
  m.add(1, {0.05, hand});
  hand.pose.p.x() -= 2.45e-3;
  m.add(1, {duration, hand});
  return m;
}

/// The last moment at which the hand feels more than half of cut_force, ms.
int released_ms(const ForceTrace& trace) {
  int last = -1;
  for (std::size_t k = 0; k < trace.force[1].size(); ++k)
    if (trace.force[1][k].norm() > cut_force / 2) last = int(k) + 1;
  return last;
}

void compare_release(const char* cut_length) {
  Bed fine(1000, cut_length);
  ASSERT_TRUE(fine.s);
  const Motion motion = drawn(*fine.s);
  const int truth = released_ms(reference_forces(*fine.s, motion, duration));
  ASSERT_GT(truth, 100);
  ASSERT_LT(truth, int(duration * 1e3) - 20);
  int latest_waiting = 0;
  for (const double rate : {30.0, 60.0, 100.0}) {
    Bed coarse(rate, cut_length);
    const auto steps = record_steps(*coarse.s, motion, duration);
    ReplaySettings settings;
    settings.latency_s = 3e-3;
    settings.servo = ServoSettings::beyond_equation_7();
    EXPECT_NEAR(released_ms(replay(steps, motion, duration, settings)), truth, 2) << rate << " Hz";
    settings.servo.substep.predict_failure = false;
    latest_waiting = std::max(latest_waiting, released_ms(replay(steps, motion, duration, settings)) - truth);
  }
  EXPECT_GT(latest_waiting, 5) << "the prediction makes no difference";
}

TEST(PartedStrand, IsReleasedWithinTwoMillisecondsOfTheBlade) { compare_release("0.7 mm"); }

// The blade leaves the strand behind before it has cut it.
TEST(PartedStrand, ThatIsPassedIsReleasedWithinTwoMilliseconds) { compare_release("5 mm"); }

}  // namespace
}  // namespace insula
