// SPDX-License-Identifier: GPL-3.0-or-later
// Faults of the campaign with real processes over LCM: loss, damage and delay of messages; processes that stop and
// continue; two engines. Times are not judged finely here, a machine under test is busy: tests/faults does that on a
// clock of its own.
#include <gtest/gtest.h>
#include <signal.h>

#include <algorithm>

#include "tests/faults/fault_cases.h"
#include "tests/process/forces.h"
#include "tests/process/play_session.h"
#include "tests/process/relay.h"

namespace insula {
namespace {

using namespace testing;

constexpr double firm_N = 0.1;

const FaultCase& fault_case(std::string_view name) {
  return *std::find_if(std::begin(fault_cases), std::end(fault_cases),
                       [&](const FaultCase& c) { return c.name == name; });
}

/// Zero by the servo's own stamps between two times; how long a fault may take to be seen here.
bool was_silent(const Watcher& watcher, std::int64_t from_us, std::int64_t to_us) {
  for (const Sample& s : watcher.samples())
    if (s.time_us > from_us && s.time_us < to_us && s.force[0].isZero(0) && s.force[1].isZero(0)) return true;
  return false;
}

class LcmFaults : public ::testing::Test {
 protected:
  void SetUp() override {
    if (!multicast_works()) GTEST_SKIP() << "no multicast on this machine";
    // The session's folder and scene; its processes are started one by one.
    bin_ = std::string(INSULA_BINARY_DIR) + "/bin/";
    scene_ = (session_.folder() / "press.xml").string();
  }
  void TearDown() override {
    if (watcher_) expect_slew_limit(watcher_->samples());
    for (ChildProcess* p : {&engine_, &second_, &server_})
      if (p->running()) p->send(SIGKILL);
  }
  void start_engine(ChildProcess& process, const std::string& url) {
    ::setenv("LCM_DEFAULT_URL", url.c_str(), 1);
    ASSERT_EQ(process.start({bin_ + "insula", "engine", scene_, "--motion", "none"}), "");
  }
  void start_server(const std::string& url) {
    ::setenv("LCM_DEFAULT_URL", url.c_str(), 1);
    ASSERT_EQ(server_.start({bin_ + "haptic_server"}), "");
    watcher_ = std::make_unique<Watcher>(url);
  }
  void start_both() {
    start_engine(engine_, session_.url());
    start_server(session_.url());
    ASSERT_TRUE(wait_for([&] { return watcher_->frames_now() > 20 && watcher_->last(); }));
    ASSERT_TRUE(watcher_->press(firm_N)) << watcher_->force();
  }

  PlaySession session_;
  std::string bin_, scene_;
  ChildProcess engine_, second_, server_;
  std::unique_ptr<Watcher> watcher_;
};

TEST_F(LcmFaults, BadLinks) {
  const std::string engine_url = own_bus_url();
  start_engine(engine_, engine_url);
  start_server(session_.url());
  Relay relay(engine_url, session_.url());
  ASSERT_TRUE(wait_for([&] { return watcher_->frames_now() > 20 && watcher_->last(); }));
  ASSERT_TRUE(watcher_->press(firm_N)) << watcher_->force();
  for (const char* name :
       {"loss", "reordering", "duplicates", "delay", "bit_flips", "bit_flips_in_all", "link_stall_500ms"}) {
    SCOPED_TRACE(name);
    const FaultCase& fault = fault_case(name);
    const std::int64_t began = now_us(), refused = watcher_->status().messages_refused;
    relay.set(fault.link);
    std::this_thread::sleep_for(1200ms);
    if (fault.zero_after_s >= 0) {
      EXPECT_TRUE(was_silent(*watcher_, began, now_us()));
      EXPECT_EQ(watcher_->force(), 0);
    }
    relay.set({});
    EXPECT_TRUE(wait_for([&] { return watcher_->force() > 0.5 * firm_N; })) << watcher_->force();
    EXPECT_TRUE(wait_for([&] { return fault.link.flip == 0 || watcher_->status().messages_refused > refused + 5; }));
  }
}

TEST_F(LcmFaults, AnEngineThatStopsAndGoesOn) {
  start_both();
  for (const auto stall : {50ms, 200ms, 500ms}) {
    SCOPED_TRACE(stall.count());
    const std::int64_t began = now_us();
    engine_.send(SIGSTOP);
    std::this_thread::sleep_for(stall);
    EXPECT_TRUE(stall < 500ms || was_silent(*watcher_, began, now_us()));
    engine_.send(SIGCONT);
    EXPECT_TRUE(wait_for([&] { return watcher_->force() > 0.5 * firm_N; })) << watcher_->force();
  }
}

TEST_F(LcmFaults, AServerThatStopsSkipsAndCountsItsTicks) {
  start_both();
  const auto before = watcher_->status();
  server_.send(SIGSTOP);
  std::this_thread::sleep_for(500ms);
  server_.send(SIGCONT);
  ASSERT_TRUE(wait_for([&] { return watcher_->status().sequence > before.sequence + 2; }));
  EXPECT_GE(watcher_->status().missed_ticks, before.missed_ticks + 400);
  EXPECT_LT(watcher_->status().ticks_per_s, 1050);  // none is made up for
  EXPECT_TRUE(wait_for([&] { return watcher_->force() > 0.5 * firm_N; })) << watcher_->force();
}

TEST_F(LcmFaults, TwoEngines) {
  start_both();
  const std::int64_t first = watcher_->frame_session();
  start_engine(second_, session_.url());
  ASSERT_TRUE(wait_for([&] { return watcher_->frames_now() > 20 && watcher_->frame_session() > first; }));
  ASSERT_TRUE(watcher_->press(firm_N)) << "the one that started last counts: " << watcher_->force();
  second_.send(SIGKILL);
  std::this_thread::sleep_for(200ms);
  ASSERT_TRUE(watcher_->press(firm_N)) << "the first engine is felt again: " << watcher_->force();
  EXPECT_EQ(watcher_->frame_session(), first);
}

}  // namespace
}  // namespace insula
