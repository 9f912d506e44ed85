// SPDX-License-Identifier: GPL-3.0-or-later
// A session with real processes: kills, garbage on the bus, pages that watch.
#include <gtest/gtest.h>

#include <random>

#include "core/bus/mutate_for_test.h"
#include "tests/process/live_session.h"
#include "tests/process/page.h"

namespace insula {
namespace {

using namespace testing;
using Buffer = std::vector<std::uint8_t>;

class Play : public LiveSession {
 protected:
  /// Forces of one life of the server are exactly zero at some time at most `longest_us` after `since_us`.
  void expect_silence(std::int64_t server, std::int64_t since_us, std::int64_t longest_us) const {
    const auto silent = [&]() -> std::optional<Sample> {
      for (const Sample& s : watcher_->samples())
        if (s.session == server && s.time_us > since_us && s.force[0].norm() == 0 && s.force[1].norm() == 0) return s;
      return std::nullopt;
    };
    ASSERT_TRUE(wait_for([&] { return silent().has_value(); }));
    EXPECT_LE(silent()->time_us - since_us, longest_us);
  }
};

// 50 ms until a problem is too old, 50 ms to ramp out, the rest for a machine with other things to do. These are stamps
// of the servo's own ticks.
constexpr std::int64_t silence_us = 400'000;

TEST_F(Play, EngineKilled) {
  const Page page(*session_);
  ASSERT_TRUE(wait_for([&] { return page.frames(watcher_->frame_session()).size() > 20; }));
  ASSERT_TRUE(watcher_->press(0.1)) << watcher_->force();
  const std::int64_t engine = watcher_->frame_session(), server = watcher_->last()->session;
  const pid_t haptic = session_->pid("haptic_server"), gateway = session_->pid("gateway");
  session_->kill_child("engine");
  expect_silence(server, now_us(), silence_us);
  // It comes back as a new run; server, gateway and page have stayed.
  ASSERT_TRUE(wait_for([&] { return watcher_->frame_session() != engine && watcher_->frames_now() > 20; }));
  EXPECT_EQ(watcher_->last()->session, server);
  EXPECT_EQ(session_->pid("haptic_server"), haptic);
  EXPECT_EQ(session_->pid("gateway"), gateway);
  ASSERT_TRUE(wait_for([&] { return page.frames(watcher_->frame_session()).size() > 20; }));
  EXPECT_EQ(page.connections(), 1);
  EXPECT_TRUE(watcher_->press(0.1)) << "no force after the engine came back: " << watcher_->force();
}

TEST_F(Play, HapticServerKilled) {
  ASSERT_TRUE(watcher_->press(0.1)) << watcher_->force();
  const std::int64_t engine = watcher_->frame_session(), server = watcher_->last()->session;
  session_->kill_child("haptic_server");
  const std::size_t frames = watcher_->frames(engine);
  ASSERT_TRUE(wait_for([&] { return watcher_->last()->session != server; }));
  ASSERT_TRUE(wait_for([&] { return watcher_->frames(engine) > frames + 60; }));
  EXPECT_EQ(watcher_->frame_session(), engine);  // the engine went on
  EXPECT_EQ(session_->count("engine started"), 1);
  EXPECT_TRUE(watcher_->press(0.1)) << "no force after the server came back: " << watcher_->force();
}

TEST_F(Play, GatewayKilled) {
  const Page page(*session_);
  ASSERT_TRUE(wait_for([&] { return page.frames(watcher_->frame_session()).size() > 20; }));
  const std::int64_t engine = watcher_->frame_session(), server = watcher_->last()->session;
  const int port = session_->port();
  session_->kill_child("gateway");
  ASSERT_TRUE(wait_for([&] { return page.connections() == 2; }));  // back at the same address
  const std::size_t before = page.frames(engine).size();
  ASSERT_TRUE(wait_for([&] { return page.frames(engine).size() > before + 20; }));
  EXPECT_EQ(session_->port(), port);
  EXPECT_EQ(watcher_->frame_session(), engine);
  EXPECT_EQ(watcher_->last()->session, server);
}

TEST_F(Play, AllKilledTogether) {
  const Page page(*session_);
  ASSERT_TRUE(watcher_->press(0.1)) << watcher_->force();
  const std::int64_t engine = watcher_->frame_session(), server = watcher_->last()->session;
  for (const char* name : {"engine", "haptic_server", "gateway"}) session_->kill_child(name);
  ASSERT_TRUE(wait_for([&] { return watcher_->last()->session != server; }));
  ASSERT_TRUE(wait_for([&] { return watcher_->frame_session() != engine && watcher_->frames_now() > 20; }));
  ASSERT_TRUE(wait_for([&] { return page.frames(watcher_->frame_session()).size() > 20; }));
  EXPECT_TRUE(watcher_->press(0.1)) << "no force after all came back: " << watcher_->force();
}

TEST_F(Play, EngineAndServerKilledOneAfterTheOther) {
  for (const char* name : {"engine", "haptic_server", "engine"}) {
    const int starts = session_->count(std::string(name) + " started");
    const std::int64_t engine = watcher_->frame_session();
    session_->kill_child(name);
    ASSERT_TRUE(wait_for([&] { return session_->count(std::string(name) + " started") > starts; }));
    if (std::string(name) == "engine") {
      ASSERT_TRUE(wait_for([&] { return watcher_->frame_session() != engine; }));
    }
    const std::size_t frames = watcher_->frames_now();
    ASSERT_TRUE(wait_for([&] { return watcher_->frames_now() > frames + 20; }));
  }
  EXPECT_TRUE(watcher_->press(0.1)) << watcher_->force();
}

TEST_F(Play, AWatchingPageGetsEveryFrame) {
  const Page page(*session_), second(*session_);
  const std::int64_t engine = watcher_->frame_session();
  ASSERT_TRUE(wait_for([&] { return page.frames(engine).size() > 600 && second.frames(engine).size() > 600; }));
  for (const Page* p : {&page, &second}) {
    const auto frames = p->frames(engine);
    const double sent = double(*frames.rbegin() - *frames.begin() + 1);
    EXPECT_GE(double(frames.size()), 0.95 * sent);
  }
}

// Refused while the tool presses; done in free air, with forces that stay within the gate's limit (checked over
// everything seen, when the test ends), and with a tool that can press again.
TEST_F(Play, AToolIsExchanged) {
  EXPECT_EQ(watcher_->tool_states(), (std::vector<int>{1, 1, 0}));
  ASSERT_TRUE(watcher_->press(0.1)) << watcher_->force();
  EXPECT_TRUE(watcher_->asked("exchange", "left spare", "refused"));
  EXPECT_EQ(watcher_->tool_states(), (std::vector<int>{1, 1, 0}));
  EXPECT_TRUE(watcher_->asked("exchange", "left spar", "refused"));
  watcher_->ask("reset");  // hands are back at home
  ASSERT_TRUE(wait_for([&] { return watcher_->force() < 0.01; }));
  std::this_thread::sleep_for(1s);
  ASSERT_TRUE(watcher_->asked("exchange", "left spare", "command"));
  EXPECT_TRUE(wait_for([&] { return watcher_->tool_states() == std::vector<int>{0, 1, 1}; }));
  EXPECT_TRUE(watcher_->press(0.1)) << "no force with the new tool: " << watcher_->force();
}

TEST_F(Play, AMessageIsAnsweredWhilePaused) {
  watcher_->ask("pause");
  EXPECT_TRUE(watcher_->asked("message", "look at the branch", "message"));
  const auto events = watcher_->events();
  EXPECT_EQ(events.back().text, "look at the branch");
  watcher_->ask("resume");
}

TEST_F(Play, GarbageOnEveryChannelChangesNothing) {
  // What really goes over the bus, to be damaged.
  std::map<std::string, Buffer> real;
  std::mutex mutex;
  {
    LcmBus listen(session_->url());
    for (const auto name : {channel::haptic_problem, channel::device_state, channel::haptic_status,
                            channel::render_frame, channel::scene_info})
      listen.subscribe(name, [&real, name](Bytes b) { real[std::string(name)].assign(b.begin(), b.end()); });
    ASSERT_TRUE(wait_for([&] {
      listen.poll(20);
      return real.size() == 5;
    }));
  }
  insula_lcm::hand_input_t input{};
  input.q[0] = 1;
  ASSERT_TRUE(encode(input, real["HAND_INPUT"]));
  insula_lcm::user_command_t command{};
  command.command = "frobnicate";
  ASSERT_TRUE(encode(command, real["USER_COMMAND"]));
  real["SIM_EVENT"] = real["SCENE_INFO"];
  const Page page(*session_);
  ASSERT_TRUE(wait_for([&] { return page.frames(watcher_->frame_session()).size() > 20; }));
  const std::int64_t engine = watcher_->frame_session(), server = watcher_->last()->session;

  std::mt19937 random(99);
  LcmBus evil(session_->url());
  for (int round = 0; round < 150; ++round) {
    for (const auto& [name, bytes] : real) {
      Buffer noise(1 + random() % 2000);
      for (auto& b : noise) b = std::uint8_t(random());
      evil.publish(name, noise);
      Buffer cut = bytes;
      cut.resize(random() % cut.size());
      evil.publish(name, cut);
      Buffer nan = bytes;  // NaN somewhere among the doubles; a text or a count is broken by it too
      for (int i = 0; i < 4 && nan.size() > 40; ++i) {
        const std::size_t at = 32 + random() % (nan.size() - 40);
        static constexpr std::uint8_t quiet[8] = {0x7f, 0xf8};
        std::copy(quiet, quiet + 8, nan.begin() + std::ptrdiff_t(at));
      }
      if (name != "SCENE_INFO" && name != "RENDER_FRAME" && name != "DEVICE_STATE") evil.publish(name, nan);
    }
    std::this_thread::sleep_for(10ms);
  }
  const std::size_t frames = watcher_->frames(engine), seen = page.frames(engine).size();
  ASSERT_TRUE(
      wait_for([&] { return watcher_->frames(engine) > frames + 60 && page.frames(engine).size() > seen + 60; }));
  EXPECT_EQ(watcher_->frame_session(), engine);
  EXPECT_EQ(watcher_->last()->session, server);
  EXPECT_EQ(page.connections(), 1);
  for (const char* name : {"engine", "haptic_server", "gateway"})
    EXPECT_EQ(session_->count(std::string(name) + " started"), 1) << name;
  EXPECT_TRUE(wait_for([&] { return watcher_->status().messages_refused >= 100; }));
}

TEST_F(Play, ASecondSessionOnTheBusStopsAndSaysHowToJoin) {
  ChildProcess second;
  ASSERT_EQ(second.start({std::string(INSULA_BINARY_DIR) + "/bin/insula", "play",
                          (session_->folder() / "press.xml").string(), "--port", "0"}),
            "");
  std::string said;
  std::optional<ChildExit> exit;
  const auto read = [&] { second.read_lines([&](std::string_view line) { said += std::string(line) + "\n"; }); };
  ASSERT_TRUE(wait_for([&] {
    read();
    return (exit = second.reap()).has_value();
  }));
  read();
  EXPECT_EQ(exit->status, 1) << said;
  EXPECT_NE(said.find("a session runs on this bus already"), std::string::npos) << said;
  EXPECT_NE(said.find(":" + std::to_string(session_->port()) + "/"), std::string::npos) << said;
  EXPECT_EQ(said.find("started (pid"), std::string::npos) << said;
  const std::size_t frames = watcher_->frames_now();
  EXPECT_TRUE(wait_for([&] { return watcher_->frames_now() > frames + 20; })) << "the first one was disturbed";
}

TEST_F(Play, InterruptEndsAllProcesses) {
  std::vector<pid_t> pids;
  for (const char* name : {"engine", "haptic_server", "gateway"}) pids.push_back(session_->pid(name));
  const ChildExit exit = session_->end();
  EXPECT_EQ(exit.status, 0) << exit.text();
  EXPECT_EQ(reports_written(), 1) << session_->log();
  for (const pid_t p : pids) EXPECT_NE(::kill(p, 0), 0) << p;
  // All ended when asked: nobody had to be killed, so each said its last word or none.
  EXPECT_TRUE(wait_for([&] { return session_->count("insula: ended") == 1; }));
}

TEST_F(Play, NothingIsLeftWhenTheSupervisorIsKilled) {
  std::vector<pid_t> pids;
  for (const char* name : {"engine", "haptic_server", "gateway"}) pids.push_back(session_->pid(name));
  ::kill(session_->supervisor(), SIGKILL);
  EXPECT_TRUE(session_->ended().has_value());
  const auto gone = [](pid_t p) {
    if (::kill(p, 0) != 0) return true;
    std::ifstream stat("/proc/" + std::to_string(p) + "/stat");
    const std::string text((std::istreambuf_iterator<char>(stat)), {});
    return text.find(") Z ") != std::string::npos;
  };
  for (const pid_t p : pids) EXPECT_TRUE(wait_for([&] { return gone(p); })) << p;
}

TEST(PlayErrors, ASceneWithErrorsStartsNothing) {
  if (!multicast_works()) GTEST_SKIP() << "no multicast on this machine";
  PlaySession session;
  std::ofstream(session.folder() / "press.xml") << "<scene titel=\"x\"/>\n";
  ASSERT_EQ(session.start(), "");
  const auto exit = session.ended();
  ASSERT_TRUE(exit);
  EXPECT_EQ(exit->status, 2);
  session.end();
  EXPECT_EQ(session.count("started (pid"), 0);
  EXPECT_EQ(session.count("did you mean \"title\"?"), 1) << session.log();
}

TEST(PlayErrors, DurationEndsTheSession) {
  if (!multicast_works()) GTEST_SKIP() << "no multicast on this machine";
  PlaySession session;
  ASSERT_EQ(session.start({"--duration", "2"}), "");
  const auto exit = session.ended();
  ASSERT_TRUE(exit);
  EXPECT_EQ(exit->status, 0);
}

}  // namespace
}  // namespace insula
