// SPDX-License-Identifier: GPL-3.0-or-later
// Loaded before a program (LD_PRELOAD): the machine's date and time jump while it runs, as when a clock is set or the
// machine was asleep. After 2 s they jump ahead by a day, after 4 s back by a week. Time since the machine's start,
// CLOCK_MONOTONIC, goes on.
#include <sys/syscall.h>
#include <sys/time.h>
#include <time.h>
#include <unistd.h>

namespace {

constexpr long day_s = 86400;

/// Of the system, without the C library.
timespec system_clock_at(clockid_t clock) {
  timespec t{};
  ::syscall(SYS_clock_gettime, clock, &t);
  return t;
}

long offset_s() {
  static const time_t began_s = system_clock_at(CLOCK_MONOTONIC).tv_sec;
  const time_t elapsed_s = system_clock_at(CLOCK_MONOTONIC).tv_sec - began_s;
  return elapsed_s < 2 ? 0 : elapsed_s < 4 ? day_s : -7 * day_s;
}

}  // namespace

extern "C" {

int clock_gettime(clockid_t clock, timespec* t) noexcept {
  const int status = int(::syscall(SYS_clock_gettime, clock, t));
  if (status == 0 && (clock == CLOCK_REALTIME || clock == CLOCK_REALTIME_COARSE)) t->tv_sec += offset_s();
  return status;
}

int gettimeofday(timeval* t, void*) noexcept {
  const timespec now = system_clock_at(CLOCK_REALTIME);
  *t = {now.tv_sec + offset_s(), now.tv_nsec / 1000};
  return 0;
}

time_t time(time_t* to) noexcept {
  const time_t now = system_clock_at(CLOCK_REALTIME).tv_sec + offset_s();
  if (to) *to = now;
  return now;
}
}
