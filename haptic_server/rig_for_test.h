// SPDX-License-Identifier: GPL-3.0-or-later
// A haptic server between an engine and a viewer, both simulated by the test, on an in-process bus with a manual clock.
#pragma once
#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <memory>
#include <string>
#include <vector>

#include "core/bus/mem_bus.h"
#include "core/haptics/haptic_update.h"
#include "haptic_server/problem_for_test.h"
#include "haptic_server/server.h"

namespace insula::testing {

inline constexpr std::int64_t ms = 1'000'000;

struct TestDirectory {
  std::filesystem::path path = std::filesystem::temp_directory_path() / ("insula_server_" + std::to_string(::getpid()));
  TestDirectory() { std::filesystem::create_directories(path); }
  ~TestDirectory() { std::filesystem::remove_all(path); }
};

/// An engine that sends problems for the last known device poses, and a viewer. The test advances the clock.
struct Rig {
  std::shared_ptr<MemHub> hub = std::make_shared<MemHub>();
  MemBus server_bus{hub}, engine_bus{hub};
  ManualClock clock{5'000'000'000};
  TestDirectory directory;
  std::string motion_file;
  std::unique_ptr<HapticServer> server;
  insula_lcm::device_state_t state{};
  bool state_seen = false;
  std::int64_t session = 100, sequence = 0, guide_sequence = 0;
  double sim_time = 0;
  bool engine_alive = true;
  bool viewer_holds = false;  ///< the viewer sends `input` every 16 ms
  insula_lcm::hand_input_t input{};
  Pose tool[2];
  std::vector<std::uint8_t> bytes;
  Vec3 last_force[2] = {Vec3::Zero(), Vec3::Zero()};
  int tick_count = 0;

  explicit Rig(const std::string& left = "simulated", const std::string& right = "simulated",
               ServerOptions options = {}) {
    tool[0].p = Vec3(-0.02, 0, 0.002);
    tool[1].p = Vec3(0.02, 0, 0.002);
    std::array<DeviceChoice, 2> devices{make_device(left, 0), make_device(right, 1)};
    for (DeviceChoice& choice : devices) choice.device->start();
    server = std::make_unique<HapticServer>(server_bus, std::move(devices), clock, std::move(options));
    engine_bus.subscribe(channel::device_state, [this](Bytes b) {
      std::string why;
      ASSERT_TRUE(decode(b, state, why)) << why;
      state_seen = true;
    });
  }

  void write_motion() {
    motion_file = (directory.path / "m.csv").string();
    std::ofstream(motion_file) << "time_s,hand,px_m,py_m,pz_m,qw,qx,qy,qz,button1,button2\n"
                                  "0,left,-0.02,0,0.01,1,0,0,0,0,0\n"
                                  "1,left,-0.02,0,-0.006,1,0,0,0,1,0\n"
                                  "3,left,-0.01,0,-0.006,1,0,0,0,1,0\n";
  }

  void send_scene(const std::string& bundle = {}) {
    insula_lcm::scene_info_t info{};
    info.session = session;
    info.time_us = clock.now_ns() / 1000;
    info.scene = "test.xml";
    info.state = "running";
    info.motion = motion_file;
    info.bundle = bundle;
    engine_bus.publish(channel::scene_info, encoded(info));
  }

  /// One message of a soft guide, as the engine sends in each step while it lasts.
  insula_lcm::soft_guide_t guide_message(int hand, std::int64_t number) {
    insula_lcm::soft_guide_t m{};
    m.session = session;
    m.sequence = ++guide_sequence;
    m.time_us = clock.now_ns() / 1000;
    m.number = number;
    m.hand = std::int8_t(hand);
    m.direction[2] = 1;
    m.force_N = 0.4;
    m.duration_s = 1.2;
    return m;
  }
  void send_guide(int hand, std::int64_t number) {
    engine_bus.publish(channel::soft_guide, encoded(guide_message(hand, number)));
  }

  template <class Message>
  const std::vector<std::uint8_t>& encoded(const Message& m) {
    EXPECT_TRUE(encode(m, bytes));
    return bytes;
  }

  HapticUpdate update() {
    HapticUpdate u;
    u.session = session;
    u.sequence = ++sequence;
    u.time_us = clock.now_ns() / 1000;
    u.step_s = 0.016;
    u.sim_time_s = sim_time;
    ConstraintProblem& p = u.problem;
    p.resize(2);
    for (int hand = 0; hand < 2; ++hand) {
      if (state_seen && state.hand[std::size_t(hand)].connected) {
        const auto& h = state.hand[std::size_t(hand)];
        tool[hand].p = Vec3(h.p_m[0], h.p_m[1], h.p_m[2]);
        tool[hand].q = Quat(h.q[0], h.q[1], h.q[2], h.q[3]);
      }
      ToolTerms t = held_tool(hand, tool[hand], 2);
      t.jacobian(hand, 2) = 1;  // tissue of 300 N/m below z = 0
      p.w[std::size_t(hand) * p.stride + hand] = t.compliance(2, 2) + 1 / 300.0;
      p.delta_free[std::size_t(hand)] = t.free.p.z();
      Block b;
      b.id = std::uint64_t(hand) + 1;
      b.row = hand;
      b.lower = 0;
      p.blocks.push_back(b);
      p.tools.push_back(t);
    }
    return u;
  }

  void send_problem() {
    ASSERT_TRUE(encode_problem(update(), bytes));
    ASSERT_TRUE(engine_bus.publish(channel::haptic_problem, bytes));
  }

  /// Runs the servo for so many milliseconds. The engine steps every 16 ms, and DEVICE_STATE is sent every 4 ms. The
  /// slew limit is checked at every tick of every test.
  void run(int milliseconds) {
    for (int k = 0; k < milliseconds; ++k, ++tick_count) {
      if (tick_count % 16 == 0 && engine_alive) {
        sim_time += 0.016;
        send_problem();
      }
      if (tick_count % 16 == 8 && viewer_holds) engine_bus.publish(channel::hand_input, encoded(input));
      server->receive(0);
      clock.advance_ns(ms);
      server->tick(clock.now_ns());
      if (tick_count % 4 == 0) server->publish_state();
      engine_bus.poll(0);
      for (int hand = 0; hand < 2; ++hand) {
        const Vec3 f = server->force(hand);
        ASSERT_LE((f - last_force[hand]).norm(), 66e-3 * (1 + 1e-9));
        last_force[hand] = f;
      }
    }
  }
};

}  // namespace insula::testing
