// SPDX-License-Identifier: GPL-3.0-or-later
// Nothing that runs in the servo thread allocates: every operator new of this program counts.
#include <gtest/gtest.h>

#include <array>
#include <vector>

#include "core/testing/count_allocations.h"
#include "haptic_server/devices/make_device.h"
#include "haptic_server/hand_guide.h"
#include "haptic_server/in_process.h"
#include "haptic_server/patched_problem_for_test.h"
#include "haptic_server/problem_for_test.h"
#include "haptic_server/rig_for_test.h"
#include "haptic_server/safety_gate.h"
#include "haptic_server/servo.h"
#include "haptic_server/welded_problem_for_test.h"

namespace insula {
namespace {

TEST(Allocation, TheCounterCounts) {
  const long before = allocations.load();
  std::vector<double>* v = new std::vector<double>(100);
  EXPECT_GE(allocations.load() - before, 2);
  delete v;
}

TEST(Allocation, TheServoDoesNone) {
  const std::array<ConstraintProblem, 5> problems{
      testing::two_tool_problem(10, 20, 1), testing::two_tool_problem(60, 60, 2),
      testing::two_tool_problem(30, 40, 3, 5), testing::with_clip(8, 4, 4), testing::with_clip(30, 0, 5)};
  for (const ServoSettings& settings : {ServoSettings(), ServoSettings::beyond_equation_7()}) {
    Servo servo(settings);
    ServoInput in;
    for (std::size_t i = 0; i < 2; ++i) {
      in.device[i] = problems[0].tools[i].device;
      in.connected[i] = true;
    }
    double sum = 0;
    const long before = allocations.load();
    for (std::size_t k = 0; k < 30; ++k) {  // problems of changing size, from the very first tick on
      servo.set_problem(&problems[k % problems.size()]);
      for (int tick = 0; tick < 4; ++tick) {
        in.device[0].p.z() -= 1e-5;
        sum += servo.tick(in).hand[0].force.norm();
      }
      if (k % 7 == 6) servo.set_problem(nullptr);
    }
    EXPECT_EQ(allocations.load() - before, 0);
    EXPECT_GT(sum, 0);
  }
}

TEST(Allocation, ContactsOnPatchesDoNone) {
  using namespace testing;
  const Vec3 centre(0, 0, patched_radius_m - 0.1e-3);
  std::array<ConstraintProblem, 3> problems{soft_triangle({}, centre, 1.0 / 60, 0.3, false, 0.01),
                                            two_tool_problem(10, 20, 1),
                                            soft_triangle({}, centre, 1.0 / 30, 0.3, true)};
  for (ConstraintProblem& p : problems) {  // and modes
    p.step_s = 1.0 / 60;
    p.reduced.add_group(std::vector<ReducedModel::Mode>(ReducedModel::max_modes, {1e-5, 1e-3, 0.01, 0}),
                        std::size_t(p.rows));
    for (double& x : p.reduced.participation) x = 1e-3;
  }
  Servo servo(ServoSettings::beyond_equation_7());
  ServoInput in;
  in.connected[1] = true;
  double sum = 0;
  const long before = allocations.load();
  for (std::size_t k = 0; k < 30; ++k) {
    servo.set_problem(&problems[k % problems.size()]);
    for (int tick = 0; tick < 10; ++tick) {
      in.device[1].p = centre + Vec3(1e-4 * tick, 0, -1e-5 * tick);
      sum += servo.tick(in).hand[1].force.norm();
    }
    if (k % 7 == 6) servo.set_problem(nullptr);
  }
  EXPECT_EQ(allocations.load() - before, 0);
  EXPECT_GT(sum, 0);
}

TEST(Allocation, DevicesGatesAndGuidesDoNone) {
  Motion motion;
  motion.add(0, {0, {Pose{Vec3(0, 0, 0), Quat::Identity()}, false, false}});
  motion.add(0, {1, {Pose{Vec3(0.01, 0, 0), from_rotation_vector(Vec3(0, 0, 1))}, true, false}});
  DeviceChoice choice = make_device("simulated", 0);
  SafetyGate gate(choice.device->profile());
  HandGuide guide;
  MotionClock clock;
  choice.device->place(Pose(), Vec3::Zero(), choice.device->profile().workspace_m);
  guide.place(Pose());
  const long before = allocations.load();
  for (int tick = 0; tick < 1000; ++tick) {
    choice.device->guide(guide.advance(1e-3, motion.at(0, clock.advance(1e-3))));
    choice.device->advance(1e-3);
    const DeviceReading r = choice.device->read();
    gate.apply(1e-3, true, -300 * r.pose.p, Vec3::Zero());
    choice.device->write(gate.force(), gate.torque());
    if (tick % 16 == 0) clock.step_arrived(1e-3 * tick, 0.016);
    if (tick == 700) guide.take_over(HandSample{});
  }
  EXPECT_EQ(allocations.load() - before, 0);
}

TEST(Allocation, TheInProcessTickDoesNone) {
  const ConstraintProblem p = testing::two_tool_problem(20, 60);
  std::array<HandHome, 2> home;
  for (std::size_t i = 0; i < 2; ++i) home[i] = {true, p.tools[i].device};
  InProcessHaptics haptics(Motion(), home);
  haptics.set_problem(p);
  haptics.set_problem(p);  // both copies have their size
  const long before = allocations.load();
  haptics.advance(100);
  EXPECT_EQ(allocations.load() - before, 0);
}

TEST(Allocation, TheServersTickDoesNone) {
  testing::Rig rig;
  rig.write_motion();
  rig.send_scene();
  insula_lcm::hand_input_t input{};
  input.q[0] = 1;
  long counted_here = 0;
  int guided = 0;
  for (int k = 0; k < 400; ++k) {  // start, placement, running, a soft guide, takeover, reset, a new engine, silence
    if (k > 30 && k % 16 == 2) rig.send_guide(0, 1);
    if (k == 100) rig.engine_bus.publish(channel::hand_input, rig.encoded(input));
    if (k == 200) rig.sim_time = 0;
    if (k == 300) {
      rig.session = 300;
      rig.sim_time = 0;
      rig.send_scene();
    }
    rig.sim_time += 1e-3;
    if (k % 16 == 0 && k < 350) rig.send_problem();
    rig.server->receive(0);
    rig.clock.advance_ns(testing::ms);
    const long before = allocations.load();
    rig.server->tick(rig.clock.now_ns());
    counted_here += allocations.load() - before;
    guided += rig.server->guided(0).norm() > 0.01;
    rig.server->publish_state();
    rig.engine_bus.poll(0);
  }
  EXPECT_EQ(counted_here, 0);
  EXPECT_GT(guided, 50) << "ticks with a soft force";
  EXPECT_TRUE(rig.server->reading(0).connected);
}

}  // namespace
}  // namespace insula
