// SPDX-License-Identifier: GPL-3.0-or-later
// One session a bus: the lock, the address it leaves, and engines that are heard.
#include "engine/live/session_lock.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include <fstream>
#include <insula_lcm/scene_info_t.hpp>
#include <thread>

#include "core/bus/channels.h"
#include "core/bus/codec.h"
#include "core/bus/mem_bus.h"

namespace insula {
namespace {

namespace fs = std::filesystem;

constexpr const char* bus_url = "udpm://239.255.76.67:7667?ttl=0";

struct Folder {
  fs::path path = fs::temp_directory_path() / ("insula_lock_" + std::to_string(::getpid()));
  Folder() { fs::create_directories(path); }
  ~Folder() { fs::remove_all(path); }
};

TEST(SessionLock, HoldsABusUntilItIsGone) {
  const Folder folder;
  {
    SessionLock first(folder.path, bus_url);
    ASSERT_TRUE(first.take());
    SessionLock second(folder.path, bus_url);
    EXPECT_FALSE(second.take());
    EXPECT_EQ(second.viewer(), "");
    first.announce("http://127.0.0.1:8080/");
    EXPECT_EQ(second.viewer(), "http://127.0.0.1:8080/");
    SessionLock elsewhere(folder.path, "udpm://239.255.76.67:7668?ttl=0");
    EXPECT_TRUE(elsewhere.take());
  }
  SessionLock later(folder.path, bus_url);
  EXPECT_TRUE(later.take());
  EXPECT_EQ(later.viewer(), "") << "the address of a session that has ended";
}

TEST(SessionLock, SaysHowToJoinAndWhichOtherBusToTake) {
  const std::string text = second_session_advice(bus_url, "http://127.0.0.1:8080/");
  for (const char* part :
       {"http://127.0.0.1:8080/?role=instructor", "LCM_DEFAULT_URL=\"udpm://239.255.76.67:7668?ttl=0\""})
    EXPECT_NE(text.find(part), std::string::npos) << text;
  EXPECT_NE(second_session_advice("memq://", "").find("7668"), std::string::npos);
}

TEST(EngineListener, HearsARunningEngineAndNoneThatHasEnded) {
  for (const char* state : {"running", "paused", "ended", ""}) {
    auto hub = std::make_shared<MemHub>();
    MemBus bus(hub), engine(hub);
    EngineListener listener(bus);
    insula_lcm::scene_info_t info{};
    info.session = 1;
    info.state = state;
    info.scene = "s.xml";
    std::vector<std::uint8_t> scratch;
    if (*state != '\0') {
      ASSERT_TRUE(publish(engine, channel::scene_info, info, scratch));
    }
    EXPECT_EQ(listener.heard(0.05), std::string(state) == "running" || std::string(state) == "paused") << state;
  }
}

}  // namespace
}  // namespace insula
