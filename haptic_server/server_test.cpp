// SPDX-License-Identifier: GPL-3.0-or-later
// The haptic server on an in-process bus with a clock that the test turns: engines come and go.
#include "haptic_server/server.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <fstream>

#include "core/haptics/haptic_update.h"
#include "haptic_server/problem_for_test.h"
#include "haptic_server/rig_for_test.h"

namespace insula {
namespace {

using testing::Rig;
using testing::TestDirectory;

TEST(Server, FollowsTheScenesMotionAndFeelsTheTissue) {
  Rig rig;
  rig.write_motion();
  rig.send_scene();
  rig.run(50);
  EXPECT_NEAR(rig.server->reading(0).pose.p.z(), 0.01, 1.5e-3);  // starts at the motion's start, not at the tool
  rig.run(2000);
  EXPECT_TRUE(rig.server->reading(0).button1);
  // Goal at -6 mm; hand 400 N/m, coupling and tissue 300 N/m each in series.
  EXPECT_NEAR(rig.server->force(0).z(), 0.006 / (1 / 400.0 + 1 / 150.0), 0.05);
  EXPECT_TRUE(rig.server->reading(1).connected);
  EXPECT_NEAR((rig.server->reading(1).pose.p - Vec3(0.02, 0, 0.002)).norm(), 0, 2e-4);  // unscripted: home
  const auto& status = rig.server->publish_status();
  EXPECT_GT(status.fresh_forces_per_s[0], 950 * 0.9);
  EXPECT_EQ(status.messages_refused, 0);
  EXPECT_EQ(status.problems_received, 129);
  EXPECT_TRUE(rig.state_seen);
  EXPECT_NEAR(rig.state.hand[0].force_N[2], rig.server->force(0).z(), 0.3);
}

TEST(Server, TellsEveryTickOfTheServo) {
  Rig rig;
  rig.write_motion();
  rig.send_scene();
  std::vector<std::int64_t> times_us;
  std::vector<float> force_z;
  rig.engine_bus.subscribe(channel::servo_ticks, [&](Bytes b) {
    insula_lcm::servo_ticks_t m{};
    std::string why;
    ASSERT_TRUE(decode(b, m, why)) << why;
    for (int k = 0; k < m.ticks; ++k) {
      times_us.push_back(m.time_us + m.after_us[std::size_t(k)]);
      force_z.push_back(m.hands[std::size_t(numbers_of_tick * k + 9)]);
    }
  });
  std::vector<float> exact;
  for (int k = 0; k < 1500; ++k) {
    rig.run(1);
    exact.push_back(float(rig.server->force(0).z()));
    if (k % 4 == 0) rig.server->collect();
  }
  rig.server->collect();
  rig.engine_bus.poll(0);
  ASSERT_EQ(force_z.size(), 1500u);
  EXPECT_EQ(force_z, exact);
  EXPECT_GT(*std::max_element(exact.begin(), exact.end()), 0.2f) << "nothing was pressed";
  for (std::size_t k = 1; k < times_us.size(); ++k) ASSERT_EQ(times_us[k] - times_us[k - 1], 1000);
}

// Of the hand that cut it, for a moment, along the force that is there; within the gate's limits, as Rig::run checks.
TEST(Server, AStrandThatPartsIsFeltByTheHandThatCutIt) {
  std::array<double, 2> most{};
  for (const bool told : {false, true}) {
    Rig rig;
    rig.write_motion();
    rig.send_scene();
    rig.run(1500);
    const Vec3 before[2] = {rig.server->force(0), rig.server->force(1)};
    insula_lcm::sim_event_t event{};
    event.session = rig.session;
    event.kind = "strand_cut";
    event.hand = 0;
    if (told) rig.engine_bus.publish(channel::sim_event, rig.encoded(event));
    event.session = rig.session - 1;  // an engine that is gone
    event.hand = 1;
    rig.engine_bus.publish(channel::sim_event, rig.encoded(event));
    double other = 0;
    for (int k = 0; k < 40; ++k) {
      rig.run(1);
      most[told] = std::max(most[told], (rig.server->force(0) - before[0]).norm());
      other = std::max(other, (rig.server->force(1) - before[1]).norm());
    }
    EXPECT_LT(other, 0.02);
  }
  EXPECT_GT(most[1], most[0] + 0.4 * severing_transient.amplitude_N);
  EXPECT_LT(most[1], most[0] + 1.5 * severing_transient.amplitude_N);
}

TEST(Server, ForcesEndWithin100msOfTheLastProblemAndComeBackGently) {
  Rig rig;
  rig.write_motion();
  rig.send_scene();
  rig.run(1500);
  ASSERT_GT(rig.server->force(0).norm(), 0.4);
  rig.engine_alive = false;
  rig.run(102);  // 50 ms until it is stale, 50 ms of ramp
  EXPECT_EQ(rig.server->force(0), Vec3(0, 0, 0));
  EXPECT_GT(rig.server->publish_status().problem_age_ms, 90);
  rig.run(500);
  EXPECT_EQ(rig.server->force(0), Vec3(0, 0, 0));
  rig.engine_alive = true;
  rig.run(60);
  EXPECT_LT(rig.server->force(0).norm(), 0.2);
  rig.run(300);
  EXPECT_GT(rig.server->force(0).norm(), 0.4);
}

TEST(Server, AStalledEnginesOldStampsDoNotPassForFreshOnes) {
  Rig rig;
  rig.write_motion();
  rig.send_scene();
  rig.run(1500);
  rig.engine_alive = false;
  const std::int64_t stamp = rig.clock.now_ns() / 1000;
  for (int k = 0; k < 20; ++k) {  // keeps arriving, keeps its old stamp
    HapticUpdate u = rig.update();
    u.time_us = stamp;
    encode_problem(u, rig.bytes);
    rig.engine_bus.publish(channel::haptic_problem, rig.bytes);
    rig.run(10);
  }
  EXPECT_EQ(rig.server->force(0), Vec3(0, 0, 0));
}

TEST(Server, ANewEngineStartsTheMotionAgain) {
  Rig rig;
  rig.write_motion();
  rig.send_scene();
  rig.run(1500);
  rig.engine_alive = false;
  rig.run(300);
  rig.session = 200;
  rig.sequence = 0;
  rig.sim_time = 0;
  rig.engine_alive = true;
  rig.send_scene();
  rig.run(40);
  EXPECT_GT(rig.server->reading(0).pose.p.z(), 0.008);
  rig.run(1500);
  EXPECT_GT(rig.server->force(0).norm(), 0.4);
}

TEST(Server, AResetStartsTheMotionAgainAndEndsATakeover) {
  Rig rig;
  rig.write_motion();
  rig.send_scene();
  rig.run(500);
  rig.input.p_m[0] = -0.03;
  rig.input.p_m[2] = 0.02;
  rig.input.q[0] = 1;
  rig.input.button2 = 1;
  rig.viewer_holds = true;
  rig.run(1000);
  EXPECT_NEAR((rig.server->reading(0).pose.p - Vec3(-0.03, 0, 0.02)).norm(), 0, 2e-4);
  EXPECT_TRUE(rig.server->reading(0).button2);
  rig.sim_time = 0;
  rig.run(40);  // the viewer has not heard of the reset yet, and still sends
  EXPECT_NEAR(rig.server->reading(0).pose.p.z(), 0.01, 2e-3);
  EXPECT_FALSE(rig.server->reading(0).button2);
}

TEST(Server, AHandIsGivenBackOnReleaseAndWhenTheViewerIsLost) {
  for (const bool released : {true, false}) {
    Rig rig;
    rig.send_scene();
    rig.run(1500);
    const Vec3 home = rig.server->reading(1).pose.p;
    rig.input.hand = 1;
    rig.input.q[0] = 1;
    rig.input.button1 = 1;
    rig.input.p_m[0] = 0.02;
    rig.input.p_m[2] = -0.004;  // in the tissue
    rig.viewer_holds = true;
    rig.run(1000);
    EXPECT_TRUE(rig.server->reading(1).button1);
    EXPECT_GT(rig.server->force(1).norm(), 0.4);
    rig.viewer_holds = false;
    if (released) {
      insula_lcm::user_command_t command{};
      command.command = "release";
      command.argument = "left";
      rig.engine_bus.publish(channel::user_command, rig.encoded(command));
      rig.run(2);
      EXPECT_TRUE(rig.server->reading(1).button1) << "the other hand was released";
      command.argument = "right";
      rig.engine_bus.publish(channel::user_command, rig.encoded(command));
    } else {
      rig.run(280);
      EXPECT_TRUE(rig.server->reading(1).button1);
      rig.run(40);
    }
    rig.run(2);
    EXPECT_FALSE(rig.server->reading(1).button1);
    rig.run(2000);
    EXPECT_NEAR((rig.server->reading(1).pose.p - home).norm(), 0, 2e-4);
    EXPECT_LT(rig.server->force(1).norm(), 0.05);
  }
}

TEST(Server, AServerThatComesLateStartsWhereTheToolsAre) {
  Rig rig;
  rig.write_motion();
  rig.sim_time = 1.5;  // the engine has been running; the motion is elsewhere by now
  rig.tool[0].p = Vec3(-0.02, 0.01, 0.02);
  rig.send_scene();
  rig.run(5);
  EXPECT_NEAR((rig.server->reading(0).pose.p - rig.tool[0].p).norm(), 0, 3e-3);
  Vec3 last = rig.server->reading(0).pose.p;
  for (int k = 0; k < 400; ++k) {
    rig.run(1);
    ASSERT_LT((rig.server->reading(0).pose.p - last).norm(), 1e-3);  // walks, never jumps
    last = rig.server->reading(0).pose.p;
  }
  EXPECT_NEAR(last.y(), 0, 1e-3);
}

TEST(Server, WithoutSceneInfoArmsStartAtTheToolsAfterAWhile) {
  Rig rig;
  rig.run(1000);
  EXPECT_FALSE(rig.server->reading(0).connected);
  rig.run(500);
  EXPECT_TRUE(rig.server->reading(0).connected);
  EXPECT_NEAR((rig.server->reading(0).pose.p - Vec3(-0.02, 0, 0.002)).norm(), 0, 2e-4);
}

TEST(Server, HomesComeFromTheScenesBundle) {
  TestDirectory directory;
  std::ofstream(directory.path / "scene.json")
      << R"({"version":1,"hands":[{"hand":"left","tool":0,"home_p_m":[0.1,0.2,0.3],"home_q":[1,0,0,0]}]})";
  const SceneSetup setup = read_scene_setup(7, "", directory.path);
  EXPECT_TRUE(setup.has_home[0]);
  EXPECT_FALSE(setup.has_home[1]);
  EXPECT_EQ(setup.home[0].p, Vec3(0.1, 0.2, 0.3));
  EXPECT_EQ(setup.problem, "");
  std::ofstream(directory.path / "scene.json") << "{\"hands\": [{\"hand\": 3}";
  EXPECT_NE(read_scene_setup(7, "", directory.path).problem, "");
  EXPECT_NE(read_scene_setup(7, "/nowhere.csv", "").problem, "");
}

TEST(Server, TheScenesForceScaleReachesTheHandAndIsSaid) {
  double force[2];
  for (const bool scaled : {false, true}) {
    Rig rig;
    rig.write_motion();
    std::ofstream(rig.directory.path / "scene.json") << (scaled ? "{\"force_scale\": 2}" : "{}");
    rig.send_scene(rig.directory.path.string());
    rig.run(2000);
    force[scaled] = rig.server->force(0).z();
    EXPECT_EQ(rig.server->publish_status().force_scale, scaled ? 2 : 1);
  }
  // Goal at -6 mm: twice the force of 150 N/m is that of 300.
  EXPECT_NEAR(force[0], 0.006 / (1 / 400.0 + 1 / 150.0), 0.05);
  EXPECT_NEAR(force[1], 0.006 / (1 / 400.0 + 1 / 300.0), 0.05);
}

TEST(Server, AMouseFollowsTheViewerAndNotTheScript) {
  Rig rig("mouse", "simulated");
  rig.write_motion();
  rig.send_scene();
  rig.run(1500);
  EXPECT_NEAR((rig.server->reading(0).pose.p - Vec3(-0.02, 0, 0.002)).norm(), 0, 2e-4);
  rig.input.p_m[2] = 0.03;
  rig.input.q[0] = 1;
  rig.viewer_holds = true;
  rig.run(1000);
  EXPECT_NEAR((rig.server->reading(0).pose.p - Vec3(0, 0, 0.03)).norm(), 0, 2e-4);
  EXPECT_EQ(rig.state.hand[0].device, "mouse");
}

}  // namespace
}  // namespace insula
