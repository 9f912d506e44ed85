// SPDX-License-Identifier: GPL-3.0-or-later
// The servo thread: wakes at absolute times, skips what it missed, asks for real-time scheduling.
#pragma once
#include <atomic>
#include <cstdint>
#include <string>

#include "haptic_server/server.h"

namespace insula {

struct RealtimeGrant {
  bool scheduler = false;  ///< SCHED_FIFO
  bool memory = false;     ///< pages locked
  std::string advice;      ///< how to get what was refused, empty when all was granted
};

/// What this process could get, tried on a short-lived thread; nothing is changed.
RealtimeGrant probe_realtime(int priority);
/// Locks the process's pages where that cannot make later allocations fail.
bool lock_memory();
/// SCHED_FIFO for the calling thread.
bool make_realtime(int priority);

/// Ticks due at start, start + period, ...; a wake-up that is whole periods late skips those ticks: they are counted
/// and never made up for.
class TickSchedule {
 public:
  TickSchedule(std::int64_t start_ns, std::int64_t period_ns) : due_(start_ns), period_(period_ns) {}
  std::int64_t due_ns() const { return due_; }
  /// At a wake-up at `now`: the due time of the tick to do now; `missed` counts the skipped ones before it.
  std::int64_t wake(std::int64_t now_ns, std::int64_t& missed);

 private:
  std::int64_t due_, period_;
};

struct LoopSettings {
  double rate_hz = 1000;
  int priority = 80;
  int spin_us =
      -1;  ///< busy waiting before each tick instead of sleeping; negative: short_spin_us where real-time is granted
};

/// Covers a wake-up from a shallow sleep of the processor; 3 % of a core at 1 kHz.
inline constexpr int short_spin_us = 30;
/// Without real-time scheduling a spin is only taken from others, and taken away from in its midst: none unless asked
/// for.
inline int chosen_spin_us(const LoopSettings& settings, bool realtime) {
  return settings.spin_us >= 0 ? settings.spin_us : realtime ? short_spin_us : 0;
}

/// Runs in the calling thread until `run` is false.
void run_servo(HapticServer& server, const LoopSettings& settings, const std::atomic<bool>& run);

}  // namespace insula
