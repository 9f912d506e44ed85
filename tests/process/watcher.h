// SPDX-License-Identifier: GPL-3.0-or-later
// An observer of a session's bus that also sends commands and presses with both hands.
#pragma once
#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <map>
#include <mutex>
#include <set>
#include <string>
#include <thread>
#include <vector>

#include "core/base/math.h"
#include "core/bus/codec.h"
#include "core/bus/lcm_bus.h"

namespace insula::testing {

using namespace std::chrono_literals;

/// Limit of every wait. It is far longer than any normal delay.
inline constexpr auto patience = 90s;

template <class Condition>
bool wait_for(Condition condition) {
  const auto end = std::chrono::steady_clock::now() + patience;
  while (std::chrono::steady_clock::now() < end) {
    if (condition()) return true;
    std::this_thread::sleep_for(5ms);
  }
  return condition();
}

inline std::int64_t now_us() {
  return std::chrono::duration_cast<std::chrono::microseconds>(std::chrono::steady_clock::now().time_since_epoch())
      .count();
}

/// One hand in one DEVICE_STATE.
struct Sample {
  std::int64_t session, sequence, time_us;
  std::array<Vec3, 2> force, position;
};

/// Collects the messages of the processes.
class Watcher {
 public:
  explicit Watcher(const std::string& url) : bus_(url), out_(url) {
    bus_.subscribe(channel::device_state, [this](Bytes b) { on_device(b); });
    bus_.subscribe(channel::render_frame, [this](Bytes b) {
      if (const auto m = decode<insula_lcm::render_frame_t>(b)) {
        std::lock_guard lock(mutex_);
        frames_[m->session].insert(m->sequence);
        frame_session_ = m->session;
        tool_states_.clear();
        for (const auto& t : m->tool) tool_states_.push_back(t.state);
      }
    });
    bus_.subscribe(channel::sim_event, [this](Bytes b) {
      if (const auto m = decode<insula_lcm::sim_event_t>(b)) {
        std::lock_guard lock(mutex_);
        events_.push_back(*m);
      }
    });
    bus_.subscribe(channel::haptic_status, [this](Bytes b) {
      if (const auto m = decode<insula_lcm::haptic_status_t>(b)) {
        std::lock_guard lock(mutex_);
        status_ = *m;
      }
    });
    thread_ = std::thread([this] {
      while (!stop_) bus_.poll(20);
    });
  }
  ~Watcher() {
    stop_ = true;
    thread_.join();
  }
  Watcher(const Watcher&) = delete;
  Watcher& operator=(const Watcher&) = delete;

  std::vector<Sample> samples() const {
    std::lock_guard lock(mutex_);
    return samples_;
  }
  std::optional<Sample> last() const {
    std::lock_guard lock(mutex_);
    return samples_.empty() ? std::nullopt : std::optional(samples_.back());
  }
  std::int64_t frame_session() const {
    std::lock_guard lock(mutex_);
    return frame_session_;
  }
  std::size_t frames(std::int64_t session) const {
    std::lock_guard lock(mutex_);
    const auto found = frames_.find(session);
    return found == frames_.end() ? 0 : found->second.size();
  }
  std::size_t frames_now() const { return frames(frame_session()); }
  insula_lcm::haptic_status_t status() const {
    std::lock_guard lock(mutex_);
    return status_;
  }
  LcmBus& out() { return out_; }
  /// States of the tools in the last frame.
  std::vector<int> tool_states() const {
    std::lock_guard lock(mutex_);
    return tool_states_;
  }
  std::vector<insula_lcm::sim_event_t> events() const {
    std::lock_guard lock(mutex_);
    return events_;
  }
  void ask(const std::string& command, const std::string& argument = "") {
    insula_lcm::user_command_t m{};
    m.time_us = now_us();
    m.sender = "test";
    m.command = command;
    m.argument = argument;
    tell(channel::user_command, m);
  }
  /// Repeats the command until an event of that kind arrives, since messages may be lost.
  bool asked(const std::string& command, const std::string& argument, const std::string& kind) {
    const std::size_t seen = events().size();
    return wait_for([&] {
      ask(command, argument);
      std::this_thread::sleep_for(100ms);
      const auto all = events();
      return std::any_of(all.begin() + std::ptrdiff_t(seen), all.end(),
                         [&](const auto& e) { return e.kind == kind && e.id == command; });
    });
  }

  /// The largest force on a hand now, N.
  double force() const {
    const auto s = last();
    return s ? std::max(s->force[0].norm(), s->force[1].norm()) : 0;
  }

  /// Lowers both hands in steps of half a millimetre until each has a force of at least `wanted` newtons. Takes the
  /// hands anew when they were placed meanwhile: a stream of poses from before a placement is ignored.
  bool press(double wanted) {
    for (const auto end = std::chrono::steady_clock::now() + patience; std::chrono::steady_clock::now() < end;) {
      holding_ = {};
      std::this_thread::sleep_for(600ms);
      if (last() && press_in_one_stream(wanted)) return true;
    }
    return false;
  }

 private:
  /// Commands and the poses of held hands come from different threads and are encoded into the same bytes.
  template <class Message>
  void tell(std::string_view channel, const Message& m) {
    std::lock_guard lock(sending_);
    publish(out_, channel, m, scratch_);
  }
  using Turns = std::array<std::array<double, 4>, 2>;
  Turns turns() const {
    std::lock_guard lock(mutex_);
    return quaternion_;
  }
  bool press_in_one_stream(double wanted) {
    std::array<Vec3, 2> at = last()->position;
    for (int step = 0; step < 600; ++step) {
      bool enough = true;
      const auto now = last();
      for (std::size_t hand = 0; hand < 2; ++hand) {
        const bool light = now->force[hand].norm() < wanted;
        enough = enough && !light;
        if (light && step % 4 == 0 && at[hand].z() > -0.02) at[hand].z() -= 0.0005;
      }
      send(at, turns());
      if (enough) {
        hold(at);
        return true;
      }
      std::this_thread::sleep_for(17ms);
    }
    return false;
  }
  void send(const std::array<Vec3, 2>& at, const Turns& turned) {
    for (std::size_t hand = 0; hand < 2; ++hand) {
      insula_lcm::hand_input_t m{};
      m.time_us = now_us();
      m.hand = std::int8_t(hand);
      for (int i = 0; i < 3; ++i) m.p_m[i] = at[hand][i];
      for (int i = 0; i < 4; ++i) m.q[i] = turned[hand][std::size_t(i)];
      tell(channel::hand_input, m);
    }
  }
  /// Keeps the hands there: a hand without news of its viewer would be given back.
  void hold(const std::array<Vec3, 2>& at) {
    holding_ = std::jthread([this, at, turned = turns()](const std::stop_token& stop) {
      while (!stop.stop_requested()) {
        send(at, turned);
        std::this_thread::sleep_for(50ms);
      }
    });
  }
  void on_device(Bytes b) {
    const auto m = decode<insula_lcm::device_state_t>(b);
    if (!m || m->hands != 2) return;
    Sample s{m->session, m->sequence, m->time_us, {}, {}};
    std::lock_guard lock(mutex_);
    for (const auto& h : m->hand) {
      s.force[h.hand] = Vec3(h.force_N[0], h.force_N[1], h.force_N[2]);
      s.position[h.hand] = Vec3(h.p_m[0], h.p_m[1], h.p_m[2]);
      std::copy(h.q, h.q + 4, quaternion_[h.hand].begin());
    }
    samples_.push_back(s);
  }

  LcmBus bus_, out_;
  std::thread thread_;
  std::atomic<bool> stop_{false};
  mutable std::mutex mutex_;
  std::vector<Sample> samples_;
  std::map<std::int64_t, std::set<std::int64_t>> frames_;
  std::int64_t frame_session_ = 0;
  std::vector<int> tool_states_;
  std::vector<insula_lcm::sim_event_t> events_;
  insula_lcm::haptic_status_t status_{};
  std::array<std::array<double, 4>, 2> quaternion_{};
  std::mutex sending_;
  std::vector<std::uint8_t> scratch_;  ///< guarded by sending_
  std::jthread holding_;               ///< ends first
};

}  // namespace insula::testing
