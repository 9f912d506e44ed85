// SPDX-License-Identifier: GPL-3.0-or-later
// The real haptic server and its gates between an engine's double and two devices' doubles, a millisecond at a time.
#pragma once
#include <gtest/gtest.h>

#include <array>
#include <memory>
#include <vector>

#include "core/bus/mem_bus.h"
#include "haptic_server/server.h"
#include "haptic_server/servo_loop.h"
#include "tests/faults/device_double.h"
#include "tests/faults/engine_double.h"

namespace insula::testing {

class FaultRig {
  std::uint64_t seed_;

 public:
  ManualClock clock{5'000'000'000'000};

 private:
  std::shared_ptr<MemHub> hub_ = std::make_shared<MemHub>();
  MemBus server_bus_{hub_};
  FaultyBus server_link_;
  std::vector<std::unique_ptr<MemBus>> engine_buses_;
  TickSchedule schedule_;

 public:
  static constexpr std::int64_t ms = 1'000'000, first_session = 1000;

  explicit FaultRig(std::uint64_t seed)
      : seed_(seed), server_link_(server_bus_, clock, ~seed), schedule_(clock.now_ns() + ms, ms) {
    std::array<DeviceChoice, 2> choice;
    for (int hand = 0; hand < 2; ++hand) {
      auto d = std::make_unique<DeviceDouble>(hand, clock);
      device[hand] = d.get();
      choice[std::size_t(hand)].device = std::move(d);
    }
    server = std::make_unique<HapticServer>(server_link_, std::move(choice), clock);
    start_engine();
  }

  void run(int milliseconds) {
    for (int k = 0; k < milliseconds; ++k) {
      clock.advance_ns(ms);
      if (each_millisecond) each_millisecond(*this);
      for (const auto& e : engines) ASSERT_NO_FATAL_FAILURE(e->live());
      server->receive(0);
      if (!servo_stalled) {
        std::int64_t missed = 0;
        const std::int64_t due = schedule_.wake(clock.now_ns(), missed);
        server->tick(due, missed);
        ++ticks;
      }
      for (DeviceDouble* d : device) d->live(1e-3);
      if (trace.size() % 4 == 0) server->publish_state();
      server_link_.deliver();
      trace.push_back({device[0]->force(), device[1]->force()});
    }
  }

  void start_engine() {
    engine_buses_.push_back(std::make_unique<MemBus>(hub_));
    engines.push_back(std::make_unique<EngineDouble>(
        *engine_buses_.back(), clock, first_session + std::int64_t(engines.size()), seed_ + engines.size()));
  }
  /// In both directions.
  void set_link(const LinkFaults& faults) {
    for (const auto& e : engines) e->link.faults = faults;
    server_link_.faults = faults;
  }
  EngineDouble& engine() { return *engines.front(); }

  std::array<DeviceDouble*, 2> device{};
  std::unique_ptr<HapticServer> server;
  std::vector<std::unique_ptr<EngineDouble>> engines;
  std::function<void(FaultRig&)> each_millisecond;
  bool servo_stalled = false;
  std::int64_t ticks = 0;
  std::vector<std::array<Vec3, 2>> trace;  ///< forces on the devices, N, one entry a millisecond
};

}  // namespace insula::testing
