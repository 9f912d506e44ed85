// SPDX-License-Identifier: GPL-3.0-or-later
// A live run waits after its first step until scripted hands are where their motion begins. It goes on by itself when
// none can come.
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <functional>
#include <random>

#include "core/bus/channels.h"
#include "core/bus/codec.h"
#include "core/bus/mem_bus.h"
#include "core/haptics/haptic_update.h"
#include "core/registry/registry.h"
#include "engine/live/live_engine.h"

namespace insula {
namespace {

namespace fs = std::filesystem;

class HandsReady : public ::testing::Test {
 protected:
  HandsReady() : folder_(fs::temp_directory_path() / ("insula_ready_" + std::to_string(std::random_device()()))) {
    fs::create_directories(folder_);
    register_builtin(registry_);
    std::ofstream(folder_ / "go.csv") << "time_s,hand,px_m,py_m,pz_m,qw,qx,qy,qz,button1,button2\n"
                                         "0,left,0.01,0,0,1,0,0,0,0,0\n2,left,0.03,0,0,1,0,0,0,0,0\n";
    std::ofstream(folder_ / "scene.xml") << R"(<scene time_step="10 ms"><exercise id="e" title="E">
      <motion id="steady" file="go.csv"/></exercise></scene>)";
    bus_.subscribe(channel::haptic_problem, [this](Bytes bytes) {
      HapticUpdate update;
      std::string why;
      ASSERT_TRUE(decode_problem(bytes, update, why)) << why;
      times_.push_back(update.sim_time_s);
      if (on_problem_) on_problem_(int(times_.size()));
    });
  }
  ~HandsReady() override { fs::remove_all(folder_); }

  void hand_at(double x_m, const char* device = "simulated") {
    insula_lcm::device_state_t m{};
    m.session = 1;
    m.sequence = ++sequence_;
    m.time_us = 1000 + sequence_;
    m.hand.resize(1);
    m.hands = 1;
    m.hand[0].device = device;
    m.hand[0].connected = true;
    m.hand[0].q[0] = 1;
    m.hand[0].p_m[0] = x_m;
    std::vector<std::uint8_t> scratch;
    EXPECT_TRUE(publish(bus_, channel::device_state, m, scratch));
  }
  void run(double duration_s) {
    LiveOptions options;
    options.scene = folder_ / "scene.xml";
    options.motion = "steady";
    options.bundle_root = folder_ / "bundle";
    options.duration = duration_s;
    options.unthrottled = true;
    options.threads = 1;
    ASSERT_EQ(run_live(options, registry_, bus_, stop_), 0);
  }
  /// Number of problems of the first step.
  long waited() const { return std::count(times_.begin(), times_.end(), times_.front()); }

  fs::path folder_;
  Registry registry_;
  MemBus bus_;
  std::atomic<bool> stop_{false};
  std::function<void(int)> on_problem_;
  std::vector<double> times_;
  std::int64_t sequence_ = 0;
};

TEST_F(HandsReady, TheMotionBeginsWhenTheHandIsAtItsStart) {
  on_problem_ = [this](int n) { hand_at(n < 20 ? 0.03 : 0.0101); };
  run(0.2);
  EXPECT_GE(waited(), 20) << "it went on while the hand was at the end of its last motion";
  EXPECT_LE(waited(), 25);
  EXPECT_NEAR(times_.front(), 0.01, 1e-12);
}

TEST_F(HandsReady, NobodyIsWaitedForWithoutAServer) {
  run(0.2);
  EXPECT_GT(waited(), 5);
  EXPECT_LT(waited(), 100) << "half a second";
}

TEST_F(HandsReady, APersonsArmIsNotWaitedFor) {
  on_problem_ = [this](int) { hand_at(0.5, "haply"); };
  run(0.2);
  EXPECT_LT(waited(), 5);
}

TEST_F(HandsReady, APersonWhoMovesAHandIsNotWaitedFor) {
  on_problem_ = [this](int n) {
    insula_lcm::hand_input_t m{};
    m.q[0] = 1;
    std::vector<std::uint8_t> scratch;
    if (n == 3) {
      EXPECT_TRUE(publish(bus_, channel::hand_input, m, scratch));
    }
    hand_at(0.5);
  };
  run(0.2);
  EXPECT_LT(waited(), 10);
}

}  // namespace
}  // namespace insula
