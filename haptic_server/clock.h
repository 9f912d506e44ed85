// SPDX-License-Identifier: GPL-3.0-or-later
// The servo's source of time: the machine's monotonic clock, or a test.
#pragma once
#include <time.h>

#include <atomic>
#include <cstdint>

namespace insula {

class Clock {
 public:
  virtual ~Clock() = default;
  virtual std::int64_t now_ns() const noexcept = 0;
};

/// CLOCK_MONOTONIC, the clock of all time_us of messages.
class MonotonicClock final : public Clock {
 public:
  std::int64_t now_ns() const noexcept override {
    timespec t;
    clock_gettime(CLOCK_MONOTONIC, &t);
    return std::int64_t(t.tv_sec) * 1'000'000'000 + t.tv_nsec;
  }
};

/// A clock that advances only by advance_ns().
class ManualClock final : public Clock {
 public:
  explicit ManualClock(std::int64_t start_ns = 0) : now_(start_ns) {}
  std::int64_t now_ns() const noexcept override { return now_.load(std::memory_order_relaxed); }
  void advance_ns(std::int64_t by) { now_.fetch_add(by, std::memory_order_relaxed); }

 private:
  std::atomic<std::int64_t> now_;
};

}  // namespace insula
