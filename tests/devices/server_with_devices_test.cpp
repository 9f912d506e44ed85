// SPDX-License-Identifier: GPL-3.0-or-later
// Real drivers of two kinds, one in each hand, in the haptic server: forces through the gate, losses in mid-contact.
#include <signal.h>
#include <sys/wait.h>

#include <fstream>
#include <mutex>

#include "core/bus/lcm_bus.h"
#include "core/haptics/haptic_update.h"
#include "core/testing/multicast.h"
#include "haptic_server/rig_for_test.h"
#include "tests/devices/device_bench.h"
#include "tests/devices/haply_stand_in.h"

namespace insula {
namespace {

using testing::HaplyStandIn;

class ServerWithDevices : public testing::DeviceBench {
 protected:
  ServerWithDevices() : service(testing::two_arms()) { ::setenv("INSULA_HAPLY_URL", service.url().c_str(), 1); }
  /// Both hands 7 mm down: 5 mm into tissue that gives 150 N/m with the coupling.
  void press() {
    put(arm(0).p, 0, -7, 0);
    service.change(0, [](auto& a) { a.p = Vec3(0, -0.12, 0.143); });
  }
  double left_force() { return arm(0).force[1]; }
  double right_force() { return service.arm(0).force.z(); }
  HaplyStandIn service;
};

/// The rig's milliseconds in real time, for drivers that have threads of their own.
bool run_until(testing::Rig& rig, const std::function<bool()>& condition, int milliseconds = 20000) {
  for (int k = 0; k < milliseconds && !::testing::Test::HasFatalFailure(); ++k) {
    if (condition()) return true;
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
    rig.run(1);
  }
  return condition();
}

TEST_F(ServerWithDevices, TwoKindsFeelTissueAndOneMayBeLostInContact) {
  testing::Rig rig("touch:Left Device", "haply:04BA");
  rig.send_scene();
  ASSERT_TRUE(run_until(rig, [&] { return rig.server->reading(0).connected && rig.server->reading(1).connected; }));
  EXPECT_NEAR((rig.server->reading(0).pose.p - Vec3(-0.02, 0, 0.002)).norm(), 0,
              1e-6);  // the rest pose lies at the hand's home
  EXPECT_EQ(rig.state.hand[0].device, "touch");
  EXPECT_EQ(rig.state.hand[1].device, "haply");
  press();
  ASSERT_TRUE(run_until(rig, [&] { return left_force() > 0.7 && right_force() > 0.7; }));
  EXPECT_NEAR(left_force(), 0.75, 0.05);
  arm(0).plugged = 0;
  ASSERT_TRUE(run_until(rig, [&] { return !rig.server->reading(0).connected; }));
  ASSERT_TRUE(run_until(
      rig, [&] { return rig.server->force(0) == Vec3(0, 0, 0); }, 200));
  EXPECT_GT(right_force(), 0.7);  // nothing to the other hand
  run_until(
      rig, [] { return false; }, 100);
  EXPECT_NE(rig.server->publish_status().note.find("left: touch:\"Left Device\""), std::string::npos)
      << rig.server->publish_status().note;
  arm(0).plugged = 1;
  ASSERT_TRUE(run_until(rig, [&] { return rig.server->reading(0).connected; }));
  EXPECT_LT(rig.server->force(0).norm(), 0.2);  // comes back gently; the rig checks every tick's slew
  ASSERT_TRUE(run_until(rig, [&] { return left_force() > 0.7; }));
  rig.server->begin_stop();
  EXPECT_TRUE(run_until(
      rig, [&] { return rig.server->quiet() && left_force() == 0 && right_force() == 0; }, 1000));
}

TEST_F(ServerWithDevices, TwoOfTheSameAndOneMissing) {
  testing::Rig rig("touch:Left Device", "touch:Nobody");
  rig.send_scene();
  ASSERT_TRUE(run_until(rig, [&] { return rig.server->reading(0).connected; }));
  EXPECT_FALSE(rig.server->reading(1).connected);
  press();
  ASSERT_TRUE(run_until(rig, [&] { return left_force() > 0.7; }));
  EXPECT_NE(rig.server->publish_status().note.find("right: touch:\"Nobody\" is not there"), std::string::npos);
  set(1, "Nobody", 5);
  EXPECT_TRUE(run_until(rig, [&] { return rig.server->reading(1).connected; }));
}

TEST_F(ServerWithDevices, ADriverThatTellsNonsenseIsLostAlone) {
  testing::Rig rig("touch:Left Device", "forcedimension:1002");
  rig.send_scene();
  ASSERT_TRUE(run_until(rig, [&] { return rig.server->reading(0).connected && rig.server->reading(1).connected; }));
  arm(1).p[0] = std::nan("");
  ASSERT_TRUE(run_until(rig, [&] { return !rig.server->reading(1).connected; }));
  EXPECT_TRUE(rig.server->reading(0).connected);
}

/// The real program in its own process. It gets an engine's problems and scenes over the bus.
class ProgramOnTheBus {
 public:
  ProgramOnTheBus(const std::string& url, const char* left, const char* right)
      : server_(started(left, right)), bus_(url) {
    bus_.subscribe(channel::device_state, [this](Bytes b) {
      std::string why;
      std::lock_guard lock(mutex_);
      engine_.state_seen = decode(b, engine_.state, why) || engine_.state_seen;
    });
  }
  /// Sends steps until the condition holds. False if it does not hold in time.
  bool until(const std::function<bool()>& condition) {
    const auto step_and_look = [&] {
      send_step();
      const auto next = std::chrono::steady_clock::now() + std::chrono::milliseconds(16);
      while (std::chrono::steady_clock::now() < next) bus_.poll(4);
      return condition();
    };
    return testing::wait_for(step_and_look, std::chrono::seconds(60));
  }
  /// Asks the program to end. Returns its exit status, or -1 if it did not end by itself.
  int end() {
    ::kill(server_, SIGTERM);
    int status = -1;
    if (::waitpid(server_, &status, 0) != server_) return -1;
    return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
  }
  const insula_lcm::hand_state_t& hand(int h) const { return engine_.state.hand[std::size_t(h)]; }
  bool both_connected() const { return engine_.state_seen && hand(0).connected && hand(1).connected; }

 private:
  static pid_t started(const char* left, const char* right) {
    const pid_t server = ::fork();
    if (server != 0) return server;
    const std::string program = INSULA_BINARY_DIR "/bin/haptic_server";
    ::execl(program.c_str(), "haptic_server", "--left", left, "--right", right, static_cast<char*>(nullptr));
    ::_exit(127);
  }
  void send_step() {
    engine_.clock.advance_ns(MonotonicClock().now_ns() - engine_.clock.now_ns());
    engine_.sim_time += 0.016;
    if (step_++ % 30 == 0) {
      insula_lcm::scene_info_t info{};
      info.session = engine_.session;
      info.time_us = engine_.clock.now_ns() / 1000;
      info.scene = "test.xml";
      info.state = "running";
      bus_.publish(channel::scene_info, engine_.encoded(info));
    }
    EXPECT_TRUE(encode_problem(engine_.update(), engine_.bytes));
    bus_.publish(channel::haptic_problem, engine_.bytes);
  }

  pid_t server_;
  testing::Rig engine_;  ///< source of the problems
  LcmBus bus_;
  std::mutex mutex_;
  int step_ = 0;
};

TEST_F(ServerWithDevices, TheRealProgramOverTheBus) {
  if (!testing::multicast_works()) GTEST_SKIP() << "no multicast on this machine";
  const std::string bus_url = testing::own_bus_url();
  ::setenv("LCM_DEFAULT_URL", bus_url.c_str(), 1);
  service.change(1, [](auto& a) { a.plugged = false; });
  std::filesystem::create_directories(folder + "/config");
  std::ofstream(folder + "/config/Left Device.config") << "";
  // The wished-for 049D is not plugged in: the left hand takes the Touch.
  ProgramOnTheBus program(bus_url, "haply:049D, touch:Left Device", "haply:04BA");
  EXPECT_TRUE(program.until([&] { return program.both_connected(); }));
  EXPECT_EQ(program.hand(0).device, "touch");
  press();
  EXPECT_TRUE(program.until([&] { return left_force() > 0.6 && right_force() > 0.6; }));
  arm(0).plugged = 0;
  EXPECT_TRUE(program.until([&] { return !program.hand(0).connected && program.hand(0).force_N[2] == 0; }));
  // A machine under load may let a problem come late, which fades forces for a moment.
  EXPECT_TRUE(program.until([&] { return right_force() > 0.6; }));
  arm(0).plugged = 1;
  EXPECT_TRUE(program.until([&] { return program.hand(0).connected && left_force() > 0.6; }));
  EXPECT_EQ(program.end(), 0);
  EXPECT_EQ(left_force(), 0);
  EXPECT_EQ(right_force(), 0);
  EXPECT_EQ(arm(0).open, 0);
}

}  // namespace
}  // namespace insula
