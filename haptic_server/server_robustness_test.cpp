// SPDX-License-Identifier: GPL-3.0-or-later
// What comes to the haptic server that should not: garbage, old and doubled messages, a stop, three threads at once.
#include "haptic_server/server.h"

#include <gtest/gtest.h>

#include <cmath>
#include <thread>

#include "core/bus/mem_bus.h"
#include "core/haptics/haptic_update.h"
#include "haptic_server/problem_for_test.h"
#include "haptic_server/rig_for_test.h"
#include "haptic_server/servo_loop.h"

namespace insula {
namespace {

using testing::Rig;

TEST(Server, GarbageChangesNothing) {
  // Two servers hear the same engine; one also hears garbage on all its channels. They must do the same.
  Rig clean, dirty;
  for (Rig* r : {&clean, &dirty}) {
    r->write_motion();
    r->send_scene();
    r->run(1200);
  }
  testing::Random random(21);
  std::vector<std::uint8_t> good;
  encode_problem(dirty.update(), good);
  --dirty.sequence;
  long sent = 0;
  for (int k = 0; k < 300; ++k) {
    for (std::string_view name : {channel::haptic_problem, channel::scene_info, channel::hand_input}) {
      std::vector<std::uint8_t> bytes(random.bits() % 400);
      for (std::uint8_t& b : bytes) b = std::uint8_t(random.bits());
      dirty.engine_bus.publish(name, bytes);
      good.resize(good.size());
      std::vector<std::uint8_t> cut(good.begin(), good.begin() + std::ptrdiff_t(random.bits() % good.size()));
      dirty.engine_bus.publish(name, cut);
      sent += 2;
    }
    HapticUpdate poisoned = dirty.update();
    --dirty.sequence;
    poisoned.sequence += 1000;
    poisoned.problem.delta_free[0] = NAN;
    encode_problem(poisoned, dirty.bytes);
    dirty.engine_bus.publish(channel::haptic_problem, dirty.bytes);
    poisoned.problem.delta_free[0] = 0;
    poisoned.time_us += 10'000'000;  // from the future
    encode_problem(poisoned, dirty.bytes);
    dirty.engine_bus.publish(channel::haptic_problem, dirty.bytes);
    sent += 2;
    clean.run(1);
    dirty.run(1);
    ASSERT_EQ(clean.server->force(0), dirty.server->force(0)) << k;
    ASSERT_EQ(clean.server->reading(0).pose.p, dirty.server->reading(0).pose.p) << k;
  }
  EXPECT_EQ(dirty.server->messages_refused(), sent);
  EXPECT_EQ(clean.server->messages_refused(), 0);
}

TEST(Server, OldAndDoubledMessagesAreIgnored) {
  Rig rig;
  rig.send_scene();
  rig.run(100);
  HapticUpdate old = rig.update();
  const std::int64_t before = rig.server->publish_status().problems_received;
  rig.sequence--;
  old.sequence -= 3;
  encode_problem(old, rig.bytes);
  rig.engine_bus.publish(channel::haptic_problem, rig.bytes);
  old.session = 5;  // an engine that was replaced
  old.sequence += 1000;
  encode_problem(old, rig.bytes);
  rig.engine_bus.publish(channel::haptic_problem, rig.bytes);
  rig.server->receive(0);
  EXPECT_EQ(rig.server->publish_status().problems_received, before);
}

TEST(Server, TheSceneOfAReplacedEngineIsIgnored) {
  Rig rig;
  rig.write_motion();
  rig.send_scene();
  rig.run(100);
  rig.session = 5;
  rig.motion_file = "";
  rig.send_scene();
  rig.session = 100;
  rig.run(1500);
  EXPECT_GT(rig.server->force(0).norm(), 0.4);  // the script of the engine that counts
}

TEST(Server, StopsWithForcesAtZero) {
  Rig rig;
  rig.write_motion();
  rig.send_scene();
  rig.run(1500);
  ASSERT_FALSE(rig.server->quiet());
  rig.server->begin_stop();
  rig.run(51);
  EXPECT_TRUE(rig.server->quiet());
}

TEST(Server, ThreeThreadsAtOnce) {
  // Real clock and threads, for the thread sanitizer; says nothing about timing.
  auto hub = std::make_shared<MemHub>();
  MemBus bus(hub);
  Rig engine;  // its problems
  const MonotonicClock clock;
  HapticServer server(bus, {make_device("simulated", 0), make_device("simulated", 1)}, clock);
  MemBus other(hub);
  std::atomic<bool> run{true};
  std::thread receiver([&] {
    while (run) server.receive(5);
  });
  std::thread servo([&] { run_servo(server, LoopSettings{}, run); });
  insula_lcm::scene_info_t info{};
  info.session = engine.session;
  info.state = "running";
  std::vector<std::uint8_t> bytes;
  insula_lcm::hand_input_t input{};
  input.q[0] = 1;
  for (int k = 0; k < 60; ++k) {
    engine.sim_time += 0.016;
    HapticUpdate u = engine.update();
    u.time_us = clock.now_ns() / 1000;
    encode_problem(u, bytes);
    other.publish(channel::haptic_problem, bytes);
    info.motion = k % 20 < 10 ? "" : "/nowhere.csv";
    publish(other, channel::scene_info, info, bytes);
    publish(other, channel::hand_input, input, bytes);
    server.publish_state();
    if (k % 10 == 9) server.publish_status();
    std::this_thread::sleep_for(std::chrono::milliseconds(4));
  }
  server.begin_stop();
  run = false;
  servo.join();
  receiver.join();
  EXPECT_GT(server.publish_status().problems_received, 0);
  EXPECT_TRUE(server.reading(0).connected);
}

}  // namespace
}  // namespace insula
