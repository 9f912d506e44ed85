// SPDX-License-Identifier: GPL-3.0-or-later
// A bus that loses, delays, duplicates, damages or holds messages. It uses a seed and the caller's clock, so that a
// failure can be repeated.
#pragma once
#include <algorithm>
#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include "core/bus/bus.h"
#include "haptic_server/clock.h"
#include "haptic_server/problem_for_test.h"

namespace insula::testing {

using Buffer = std::vector<std::uint8_t>;

/// Shares are of the messages, 0 to 1.
struct LinkFaults {
  double lose = 0;
  double duplicate = 0;     ///< comes again, some time within the next 50 ms
  double flip = 0;          ///< with one to eight bits turned over
  double late_least_s = 0;  ///< each message's own delay, so that they overtake one another
  double late_most_s = 0;
  bool hold = false;  ///< nothing passes; all of it comes at once when this is over
};

/// Decorates the sending side of `inner`. For one thread.
class FaultyBus final : public Bus {
 public:
  FaultyBus(Bus& inner, const Clock& clock, std::uint64_t seed) : inner_(inner), clock_(clock), random_(seed) {}

  LinkFaults faults;

  bool publish(std::string_view channel, Bytes message) override {
    if (chance(faults.lose)) return true;
    Buffer bytes(message.begin(), message.end());
    if (chance(faults.flip))
      for (std::uint64_t n = 1 + random_.bits() % 8; n > 0; --n) {
        const std::uint64_t bit = random_.bits() % (8 * bytes.size());
        bytes[bit / 8] ^= std::uint8_t(1u << (bit % 8));
      }
    const double late = faults.late_least_s + share() * (faults.late_most_s - faults.late_least_s);
    if (chance(faults.duplicate)) wait(channel, bytes, late + 0.05 * share());
    wait(channel, std::move(bytes), late);
    deliver();
    return true;
  }
  void subscribe(std::string_view channel, Handler handler) override { inner_.subscribe(channel, std::move(handler)); }
  int poll(int timeout_ms) override {
    deliver();
    return inner_.poll(timeout_ms);
  }
  bool good() const override { return inner_.good(); }
  std::string error() const override { return inner_.error(); }

  /// Sends the messages that are due, in order.
  void deliver() {
    if (faults.hold) return;
    const auto first_not = std::stable_partition(waiting_.begin(), waiting_.end(),
                                                 [now = clock_.now_ns()](const Waiting& w) { return w.due_ns <= now; });
    std::stable_sort(waiting_.begin(), first_not,
                     [](const Waiting& a, const Waiting& b) { return a.due_ns < b.due_ns; });
    for (auto w = waiting_.begin(); w != first_not; ++w) inner_.publish(w->channel, w->bytes);
    waiting_.erase(waiting_.begin(), first_not);
  }

 private:
  struct Waiting {
    std::int64_t due_ns;
    std::string channel;
    Buffer bytes;
  };
  double share() { return 0.5 * (random_.next() + 1); }
  bool chance(double of) { return of > 0 && share() < of; }
  void wait(std::string_view channel, Buffer bytes, double late_s) {
    waiting_.push_back({clock_.now_ns() + std::int64_t(late_s * 1e9), std::string(channel), std::move(bytes)});
  }

  Bus& inner_;
  const Clock& clock_;
  Random random_;
  std::vector<Waiting> waiting_;
};

}  // namespace insula::testing
