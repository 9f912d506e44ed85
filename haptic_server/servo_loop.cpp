// SPDX-License-Identifier: GPL-3.0-or-later
// Timing and scheduling of the servo thread.
#include "haptic_server/servo_loop.h"

#include <pthread.h>
#include <sched.h>
#include <sys/mman.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <time.h>
#include <unistd.h>
#include <cerrno>

#include <algorithm>
#include <thread>

namespace insula {

bool make_realtime(int priority) {
  sched_param p{};
  p.sched_priority = std::clamp(priority, sched_get_priority_min(SCHED_FIFO), sched_get_priority_max(SCHED_FIFO));
  return pthread_setschedparam(pthread_self(), SCHED_FIFO, &p) == 0;
}

bool lock_memory() {
  // With a limit, locking of future pages would make ordinary allocations fail.
  rlimit limit{};
  const bool unlimited = getrlimit(RLIMIT_MEMLOCK, &limit) == 0 && limit.rlim_cur == RLIM_INFINITY;
  if (unlimited || geteuid() == 0) {
    if (mlockall(MCL_CURRENT | MCL_FUTURE) == 0) return true;
  }
  return mlockall(MCL_CURRENT) == 0;
}

RealtimeGrant probe_realtime(int priority) {
  RealtimeGrant grant;
  std::thread([&] { grant.scheduler = make_realtime(priority); }).join();
  grant.memory = lock_memory();
  if (!grant.scheduler)
    grant.advice =
        "real-time scheduling was refused, so forces may come late under load; to allow it: sudo setcap "
        "cap_sys_nice,cap_ipc_lock+ep haptic_server, or \"@haptics - rtprio 80\" in /etc/security/limits.d/insula.conf "
        "(in a container: --cap-add SYS_NICE --ulimit rtprio=80)";
  else if (!grant.memory)
    grant.advice =
        "memory could not be locked; to allow it: sudo setcap cap_sys_nice,cap_ipc_lock+ep haptic_server, or "
        "\"@haptics - memlock unlimited\" in /etc/security/limits.d/insula.conf";
  return grant;
}

std::int64_t TickSchedule::wake(std::int64_t now_ns, std::int64_t& missed) {
  missed = now_ns > due_ ? (now_ns - due_) / period_ : 0;
  const std::int64_t due = due_;
  due_ += (missed + 1) * period_;
  return due;
}

void run_servo(HapticServer& server, const LoopSettings& settings, const std::atomic<bool>& run) {
  prctl(PR_SET_TIMERSLACK, 1UL, 0UL, 0UL, 0UL);  // 50 us by default, for threads without a real-time class
  const int spin_us = chosen_spin_us(settings, make_realtime(settings.priority));
  const MonotonicClock clock;
  const auto period = std::int64_t(1e9 / settings.rate_hz);
  TickSchedule schedule(clock.now_ns() + period, period);
  while (run.load(std::memory_order_relaxed)) {
    const std::int64_t due = schedule.due_ns();
    const std::int64_t sleep_until = due - std::int64_t(spin_us) * 1000;
    const timespec at{time_t(sleep_until / 1'000'000'000), long(sleep_until % 1'000'000'000)};
    while (clock_nanosleep(CLOCK_MONOTONIC, TIMER_ABSTIME, &at, nullptr) == EINTR) {
    }
    while (clock.now_ns() < due) {
    }
    std::int64_t missed = 0;
    const std::int64_t tick_due = schedule.wake(clock.now_ns(), missed);
    server.tick(tick_due, missed);
  }
}

}  // namespace insula
