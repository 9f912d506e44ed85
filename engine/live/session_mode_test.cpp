// SPDX-License-Identifier: GPL-3.0-or-later
// A session waits until somebody chooses what it is for, and then starts from the beginning.
#include "engine/live/session_mode.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include <chrono>
#include <fstream>
#include <insula_lcm/render_frame_t.hpp>
#include <insula_lcm/sim_event_t.hpp>
#include <insula_lcm/user_command_t.hpp>
#include <nlohmann/json.hpp>
#include <thread>

#include "core/bus/channels.h"
#include "core/bus/codec.h"
#include "core/bus/mem_bus.h"
#include "core/registry/registry.h"
#include "engine/live/live_engine.h"

namespace insula {
namespace {

namespace fs = std::filesystem;

/// An engine of a scene with an empty exercise, and a page that listens.
class WaitingSession : public ::testing::Test {
 protected:
  WaitingSession() {
    fs::create_directories(folder_);
    std::ofstream(folder_ / "s.xml") << R"(<scene time_step="10 ms"><exercise id="e" title="E"/></scene>)";
    register_builtin(registry_);
    page_.subscribe(channel::render_frame, [this](Bytes b) {
      const auto m = decode<insula_lcm::render_frame_t>(b);
      ASSERT_TRUE(m);
      mode_ = nlohmann::json::parse(m->hud_json).at("mode");
      time_s_ = m->sim_time_s;
      ++frames_;
    });
    page_.subscribe(channel::sim_event, [this](Bytes b) {
      if (const auto m = decode<insula_lcm::sim_event_t>(b)) events_.push_back(m->kind + " " + m->text);
    });
    LiveOptions options;
    options.scene = folder_ / "s.xml";
    options.bundle_root = folder_ / "bundles";
    options.mode = SessionMode::waiting;
    engine_ = std::thread([this, options] { run_live(options, registry_, bus_, stop_); });
  }
  ~WaitingSession() override {
    stop_ = true;
    engine_.join();
    fs::remove_all(folder_);
  }
  void ask(const char* command, const char* argument) {
    insula_lcm::user_command_t m{};
    m.command = command;
    m.argument = argument;
    ASSERT_TRUE(publish(page_, channel::user_command, m, scratch_));
  }
  template <class Condition>
  bool eventually(Condition condition) {
    for (int k = 0; k < 6000 && !condition(); ++k) page_.poll(10);
    return condition();
  }

  fs::path folder_ = fs::temp_directory_path() / ("insula_mode_" + std::to_string(::getpid()));
  std::shared_ptr<MemHub> hub_ = std::make_shared<MemHub>();
  MemBus bus_{hub_}, page_{hub_};
  Registry registry_;
  std::atomic<bool> stop_{false};
  std::thread engine_;
  std::string mode_;
  double time_s_ = 0;
  int frames_ = 0;
  std::vector<std::string> events_;
  std::vector<std::uint8_t> scratch_;
};

TEST_F(WaitingSession, TimeStandsUntilAModeIsChosen) {
  ASSERT_TRUE(eventually([&] { return frames_ > 20; }));
  EXPECT_EQ(mode_, "waiting");
  EXPECT_EQ(time_s_, 0);
  ask("begin", "demonstration");
  EXPECT_TRUE(eventually([&] { return !events_.empty(); }));
  EXPECT_EQ(events_.front().substr(0, 8), "refused ") << "the scene has no motion to show";
  EXPECT_EQ(mode_, "waiting");
  ask("begin", "test");
  ASSERT_TRUE(eventually([&] { return mode_ == "test" && time_s_ > 0.2; }));
  ask("begin", "practice");
  ASSERT_TRUE(eventually([&] { return mode_ == "practice"; }));
  EXPECT_LT(time_s_, 0.2) << "it starts again";
  ask("read", "Look there");
  EXPECT_TRUE(eventually([&] { return events_.back() == "read Look there"; }));
}

TEST(SessionMode, HasNames) {
  EXPECT_EQ(name_of(SessionMode::demonstration), "demonstration");
  EXPECT_EQ(session_mode("practice"), SessionMode::practice);
  EXPECT_EQ(session_mode("play"), std::nullopt);
  EXPECT_EQ(session_mode(""), std::nullopt);
}

}  // namespace
}  // namespace insula
