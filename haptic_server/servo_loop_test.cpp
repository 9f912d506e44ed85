// SPDX-License-Identifier: GPL-3.0-or-later
// The servo's beat and its statistics.
#include "haptic_server/servo_loop.h"

#include <gtest/gtest.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <fstream>

#include "haptic_server/status.h"

namespace insula {
namespace {

/// Of this process, as the kernel says it.
long locked_kB() {
  std::ifstream file("/proc/self/status");
  for (std::string word; file >> word;)
    if (long kB = 0; word == "VmLck:" && file >> kB) return kB;
  return -1;
}

constexpr std::int64_t ms = 1'000'000;

TEST(TickSchedule, SkipsWhatItMissedAndKeepsItsBeat) {
  TickSchedule s(10 * ms, ms);
  std::int64_t missed = -1;
  EXPECT_EQ(s.wake(10 * ms + 5, missed), 10 * ms);
  EXPECT_EQ(missed, 0);
  EXPECT_EQ(s.due_ns(), 11 * ms);
  EXPECT_EQ(s.wake(14 * ms + ms / 2, missed), 11 * ms);  // 12, 13 and 14 are gone
  EXPECT_EQ(missed, 3);
  EXPECT_EQ(s.due_ns(), 15 * ms);
  EXPECT_EQ(s.wake(15 * ms, missed), 15 * ms);
  EXPECT_EQ(missed, 0);
}

TEST(Status, PercentilesRatesAndANewPeriod) {
  StatusCollector c;
  for (int k = 1; k <= 100; ++k) {
    TickSample s;
    s.lateness_us = float(k);
    s.solve_us = float(2 * k);
    s.solved = true;
    s.sweeps = 4;
    s.residual_m = k == 50 ? 1e-6f : 1e-9f;
    s.fresh = {true, k % 2 == 0};
    c.add(s);
  }
  insula_lcm::haptic_status_t m{};
  c.finish(0.1, m);
  EXPECT_NEAR(m.ticks_per_s, 1000, 1e-9);
  EXPECT_NEAR(m.fresh_forces_per_s[0], 1000, 1e-9);
  EXPECT_NEAR(m.fresh_forces_per_s[1], 500, 1e-9);
  EXPECT_NEAR(m.lateness_us_p50, 51, 0);
  EXPECT_NEAR(m.lateness_us_p99, 100, 0);
  EXPECT_NEAR(m.lateness_us_max, 100, 0);
  EXPECT_NEAR(m.solve_us_p50, 102, 0);
  EXPECT_NEAR(m.sweeps_mean, 4, 0);
  EXPECT_NEAR(m.residual_m_max, 1e-6, 1e-12);
  c.finish(0.1, m);
  EXPECT_EQ(m.ticks_per_s, 0);
  EXPECT_EQ(m.residual_m_max, 0);
}

TEST(ServoLoop, SpinsShortlyWhereRealTimeIsGrantedAndAsAskedForElsewhere) {
  LoopSettings s;
  EXPECT_EQ(chosen_spin_us(s, true), short_spin_us);
  EXPECT_EQ(chosen_spin_us(s, false), 0);
  s.spin_us = 100;
  EXPECT_EQ(chosen_spin_us(s, false), 100);
  s.spin_us = 0;
  EXPECT_EQ(chosen_spin_us(s, true), 0);
}

TEST(ServoLoop, SaysHowToAllowRealTimeWhereItIsRefused) {
  // In a process of its own that gives up its rights.
  const pid_t child = fork();
  if (child == 0) {
    const rlimit none{0, 0};
    if (setrlimit(RLIMIT_RTPRIO, &none) != 0 || (geteuid() == 0 && setuid(65534) != 0)) _exit(2);
    const RealtimeGrant grant = probe_realtime(80);
    _exit(!grant.scheduler && grant.advice.find("real-time scheduling was refused") == 0 &&
                  grant.advice.find("setcap") != std::string::npos
              ? 0
              : 1);
  }
  int status = 0;
  ASSERT_EQ(waitpid(child, &status, 0), child);
  EXPECT_EQ(WIFEXITED(status) ? WEXITSTATUS(status) : -1, 0);
}

TEST(ServoLoop, LocksItsMemoryWhereItMayAndSaysSoWhereNot) {
#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
  GTEST_SKIP() << "the sanitizers' runtime ignores mlockall";
#endif
  // In processes of their own: one as this one is, one without the right to lock anything.
  for (const bool allowed : {true, false}) {
    const pid_t child = fork();
    if (child == 0) {
      const rlimit none{0, 0};
      if (locked_kB() != 0) _exit(3);
      if (!allowed && (setrlimit(RLIMIT_MEMLOCK, &none) != 0 || (geteuid() == 0 && setuid(65534) != 0))) _exit(2);
      const RealtimeGrant grant = probe_realtime(80);
      if (!allowed && grant.memory) _exit(4);
      // With rights of its own it locks all that it has: more than this program's code.
      if (grant.memory) _exit(locked_kB() > 1000 ? 0 : 5);
      _exit(locked_kB() == 0 && grant.advice.find("cap_ipc_lock") != std::string::npos ? 0 : 6);
    }
    int status = 0;
    ASSERT_EQ(waitpid(child, &status, 0), child);
    EXPECT_EQ(WIFEXITED(status) ? WEXITSTATUS(status) : -1, 0) << (allowed ? "as it is" : "without rights");
  }
}

}  // namespace
}  // namespace insula
