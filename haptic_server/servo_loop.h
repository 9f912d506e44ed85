// SPDX-License-Identifier: GPL-3.0-or-later
// The servo thread: wakes at absolute times, skips missed ticks, requests real-time scheduling.
#pragma once
#include <atomic>
#include <cstdint>
#include <string>

#include "haptic_server/server.h"

namespace insula {

struct RealtimeGrant {
  bool scheduler = false;  ///< SCHED_FIFO
  bool memory = false;     ///< pages locked
  std::string advice;      ///< how to get what was refused; empty if all was granted
};

/// Real-time rights of this process, tested on a short-lived thread without lasting changes.
RealtimeGrant probe_realtime(int priority);
/// Locks the process's pages, unless later allocations could then fail.
bool lock_memory();
/// Requests SCHED_FIFO for the calling thread.
bool make_realtime(int priority);

/// Ticks due at start, start + period, ...; a wake-up that is whole periods late skips those ticks. They are counted
/// and never repeated.
class TickSchedule {
 public:
  TickSchedule(std::int64_t start_ns, std::int64_t period_ns) : due_(start_ns), period_(period_ns) {}
  std::int64_t due_ns() const { return due_; }
  /// Due time of the present tick for a wake-up at `now_ns`. `missed` counts the skipped ticks before it.
  std::int64_t wake(std::int64_t now_ns, std::int64_t& missed);

 private:
  std::int64_t due_, period_;
};

struct LoopSettings {
  double rate_hz = 1000;
  int priority = 80;
  int spin_us =
      -1;  ///< busy waiting before each tick instead of sleeping; negative: short_spin_us if real-time is granted
};

/// Time of a wake-up from a shallow sleep of the processor. It costs 3 % of a core at 1 kHz.
inline constexpr int short_spin_us = 30;
/// Without real-time scheduling, a spin only takes time from other threads and may itself be interrupted. So there is
/// none unless it is requested.
inline int chosen_spin_us(const LoopSettings& settings, bool realtime) {
  return settings.spin_us >= 0 ? settings.spin_us : realtime ? short_spin_us : 0;
}

/// Runs in the calling thread until `run` is false.
void run_servo(HapticServer& server, const LoopSettings& settings, const std::atomic<bool>& run);

}  // namespace insula
