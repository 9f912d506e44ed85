// SPDX-License-Identifier: GPL-3.0-or-later
// A relay with faults between an engine's bus and a haptic server's bus. Two LCM addresses, one thread.
#pragma once
#include <atomic>
#include <memory>
#include <mutex>
#include <string>
#include <thread>
#include <vector>

#include "core/bus/channels.h"
#include "core/bus/lcm_bus.h"
#include "tests/faults/faulty_bus.h"

namespace insula::testing {

class Relay {
 public:
  Relay(const std::string& engine_url, const std::string& server_url)
      : engine_(engine_url), server_(server_url), to_engine_(engine_, clock_, 17), to_server_(server_, clock_, 18) {
    for (const auto name : {channel::haptic_problem, channel::scene_info, channel::render_frame})
      engine_.subscribe(name, [this, name](Bytes b) { to_server_.publish(name, b); });
    for (const auto name : {channel::device_state, channel::hand_input})
      server_.subscribe(name, [this, name](Bytes b) { to_engine_.publish(name, b); });
    thread_ = std::thread([this] {
      while (!stop_) {
        {
          std::lock_guard lock(mutex_);
          to_engine_.faults = to_server_.faults = faults_;
        }
        engine_.poll(1);
        server_.poll(1);
        to_engine_.deliver();
        to_server_.deliver();
      }
    });
  }
  ~Relay() {
    stop_ = true;
    thread_.join();
  }
  Relay(const Relay&) = delete;
  Relay& operator=(const Relay&) = delete;

  void set(const LinkFaults& faults) {
    std::lock_guard lock(mutex_);
    faults_ = faults;
  }

 private:
  MonotonicClock clock_;
  LcmBus engine_, server_;
  FaultyBus to_engine_, to_server_;
  std::mutex mutex_;
  LinkFaults faults_;
  std::atomic<bool> stop_{false};
  std::thread thread_;
};

}  // namespace insula::testing
