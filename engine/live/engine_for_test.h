// SPDX-License-Identifier: GPL-3.0-or-later
// A live engine under test: beside a page that listens, or in this thread, where a test acts between two steps.
#pragma once
#include <gtest/gtest.h>

#include <atomic>
#include <functional>
#include <insula_lcm/device_state_t.hpp>
#include <insula_lcm/render_frame_t.hpp>
#include <insula_lcm/sim_event_t.hpp>
#include <insula_lcm/user_command_t.hpp>
#include <memory>
#include <nlohmann/json.hpp>
#include <string>
#include <thread>
#include <vector>

#include "core/bus/channels.h"
#include "core/bus/codec.h"
#include "core/bus/mem_bus.h"
#include "core/registry/registry.h"
#include "core/testing/temp_folder.h"
#include "engine/live/live_engine.h"

namespace insula::test {

template <class Message>
void send(Bus& bus, std::string_view channel, const Message& message) {
  std::vector<std::uint8_t> scratch;
  EXPECT_TRUE(publish(bus, channel, message, scratch));
}

/// A request as a page sends it.
inline void ask(Bus& bus, const std::string& command, const std::string& argument = "") {
  insula_lcm::user_command_t m{};
  m.time_us = 1;
  m.sender = "test";
  m.command = command;
  m.argument = argument;
  send(bus, channel::user_command, m);
}

/// An engine in a thread of its own, in real time, and a page that listens.
class RunningEngine : public testing::Test {
 protected:
  RunningEngine() {
    register_builtin(registry_);
    page_.subscribe(channel::render_frame, [this](Bytes b) {
      const auto m = decode<insula_lcm::render_frame_t>(b);
      ASSERT_TRUE(m);
      hud_ = nlohmann::json::parse(m->hud_json);
      time_s_ = m->sim_time_s;
      ++frames_;
    });
    page_.subscribe(channel::sim_event, [this](Bytes b) {
      if (auto m = decode<insula_lcm::sim_event_t>(b)) events_.push_back(std::move(*m));
    });
  }
  ~RunningEngine() override {
    stop_ = true;
    if (engine_.joinable()) engine_.join();
  }

  void start(const std::string& scene, SessionMode mode) {
    LiveOptions options;
    options.scene = folder_.write("s.xml", scene);
    options.bundle_root = folder_.path() / "bundles";
    options.mode = mode;
    engine_ = std::thread([this, options] { run_live(options, registry_, bus_, stop_); });
  }
  void ask(const std::string& command, const std::string& argument) { test::ask(page_, command, argument); }
  template <class Condition>
  bool eventually(Condition condition) {
    for (int k = 0; k < 6000 && !condition(); ++k) page_.poll(10);
    return condition();
  }
  bool said(const std::string& kind, const std::string& id) {
    return eventually([&] {
      return std::any_of(events_.begin(), events_.end(), [&](const auto& e) { return e.kind == kind && e.id == id; });
    });
  }
  std::string mode() const { return frames_ > 0 ? hud_.at("mode").get<std::string>() : std::string(); }

  test_files::TempFolder folder_;
  std::shared_ptr<MemHub> hub_ = std::make_shared<MemHub>();
  MemBus bus_{hub_}, page_{hub_};
  Registry registry_;
  std::atomic<bool> stop_{false};
  // What the page heard.
  nlohmann::json hud_;
  double time_s_ = 0;
  int frames_ = 0;
  std::vector<insula_lcm::sim_event_t> events_;

 private:
  std::thread engine_;
};

/// An engine in this thread, as fast as it can, for one run. What it says in each step is where a test acts: in
/// simulated time, whatever the machine does. It is heard before the next step; that of the last one no more.
class EngineInStep {
 protected:
  EngineInStep() {
    register_builtin(registry_);
    bus_.subscribe(channel::haptic_problem, [this](Bytes) {
      ++steps_;
      if (on_step_) on_step_(steps_);
    });
  }

  LiveOptions options(std::filesystem::path scene, double duration_s) const {
    LiveOptions out;
    out.scene = std::move(scene);
    out.bundle_root = folder_.path() / "bundle";
    out.duration = duration_s;
    out.unthrottled = true;
    out.threads = 1;
    return out;
  }
  int run(const LiveOptions& options) { return run_live(options, registry_, bus_, stop_); }
  void ask(const std::string& command, const std::string& argument = "") { test::ask(bus_, command, argument); }
  /// A message of the haptic server on one hand.
  void send_hand(insula_lcm::hand_state_t hand) {
    insula_lcm::device_state_t m{};
    m.session = 1;
    m.sequence = ++sequence_;
    m.time_us = 1000 + sequence_;
    m.hands = 1;
    m.hand.push_back(std::move(hand));
    send(bus_, channel::device_state, m);
  }
  static insula_lcm::hand_state_t connected_hand(int hand, const char* device, const Pose& pose = {}) {
    insula_lcm::hand_state_t out{};
    out.hand = std::int8_t(hand);
    out.device = device;
    out.connected = true;
    for (int k = 0; k < 3; ++k) out.p_m[k] = pose.p[k];
    out.q[0] = pose.q.w();
    for (int k = 0; k < 3; ++k) out.q[k + 1] = pose.q.vec()[k];
    return out;
  }

  test_files::TempFolder folder_;
  Registry registry_;
  MemBus bus_;
  std::atomic<bool> stop_{false};
  std::function<void(int)> on_step_;
  int steps_ = 0;  ///< problems that were sent

 private:
  std::int64_t sequence_ = 0;
};

}  // namespace insula::test
