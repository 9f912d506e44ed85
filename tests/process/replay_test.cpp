// SPDX-License-Identifier: GPL-3.0-or-later
// LCM's own tools on a running session: lcm-logger records it, lcm-logplayer and `insula replay` bring it back to a
// page.
#include <gtest/gtest.h>
#include <signal.h>

#include <boost/beast/http.hpp>

#include "core/bus/event_log.h"
#include "tests/process/page.h"

namespace insula {
namespace {

using namespace testing;
const char* const logger = "/usr/bin/lcm-logger";
const char* const player = "/usr/bin/lcm-logplayer";

/// A child with its output.
class Tool {
 public:
  explicit Tool(const std::vector<std::string>& command) { EXPECT_EQ(process.start(command), ""); }
  ChildExit end(int signal = 0) {
    if (signal != 0) process.send(signal);
    std::optional<ChildExit> exit;
    wait_for([&] {
      read();
      return (exit = process.reap()).has_value();
    });
    process.finish_output([this](std::string_view l) { said += std::string(l) + "\n"; });
    return exit.value_or(ChildExit{-1, SIGKILL});
  }
  void read() {
    process.read_lines([this](std::string_view l) { said += std::string(l) + "\n"; });
  }
  ChildProcess process;
  std::string said;
};

unsigned http_status(int port, const std::string& target) {
  namespace http = boost::beast::http;
  boost::asio::io_context io;
  boost::asio::ip::tcp::socket socket(io);
  socket.connect({boost::asio::ip::make_address("127.0.0.1"), std::uint16_t(port)});
  http::request<http::empty_body> request{http::verb::get, target, 11};
  request.set(http::field::host, "127.0.0.1");
  http::write(socket, request);
  boost::beast::flat_buffer buffer;
  http::response_parser<http::string_body> parser;
  parser.body_limit(boost::none);
  http::read(socket, buffer, parser);
  return parser.get().result_int();
}

class Replay : public ::testing::Test {
 protected:
  void SetUp() override {
    if (!lcm_tools_work()) GTEST_SKIP() << "no multicast route on this machine, and no rights to add one";
    if (::access(logger, X_OK) != 0 || ::access(player, X_OK) != 0) GTEST_SKIP() << "liblcm-bin is not installed";
    insula_ = std::string(INSULA_BINARY_DIR) + "/bin/insula";
    record();
  }
  /// A few seconds of `insula play`, as the manual says.
  void record() {
    const fs::path folder = session_.folder() / "recording";
    fs::create_directories(folder);
    log_ = folder / "session.lcmlog";
    ASSERT_EQ(session_.start({"--keep-bundle", folder.string(), "--duration", "20"}), "");
    Watcher watcher(session_.url());
    ASSERT_TRUE(wait_for([&] { return watcher.frames_now() > 5 && watcher.last(); })) << session_.log();
    Tool tool({logger, log_.string()});
    const std::size_t frames = watcher.frames_now();
    ASSERT_TRUE(wait_for([&] { return watcher.frames_now() > frames + 150; }));
    recorded_ = watcher.frame_session();
    tool.end(SIGINT);
    session_.end();
    ASSERT_GT(fs::file_size(log_), 100'000u) << tool.said;
  }
  void start_gateway() {
    ::setenv("LCM_DEFAULT_URL", url_.c_str(), 1);
    gateway_ = std::make_unique<Tool>(
        std::vector<std::string>{std::string(INSULA_BINARY_DIR) + "/bin/gateway", "--port", "0"});
    ASSERT_TRUE(wait_for([&] {
      gateway_->read();
      const std::size_t at = gateway_->said.find("serving http"),
                        end = gateway_->said.find('\n', at == std::string::npos ? 0 : at);
      if (at == std::string::npos || end == std::string::npos) return false;
      port_ = std::atoi(gateway_->said.c_str() + gateway_->said.rfind(':', end) + 1);
      return true;
    }));
  }

  PlaySession session_;
  std::string insula_, url_ = own_bus_url();
  fs::path log_;
  std::int64_t recorded_ = 0;
  std::unique_ptr<Tool> gateway_;
  int port_ = 0;
};

TEST_F(Replay, BothPlayersBringTheSessionToAPage) {
  // What the logger wrote is whole, and what is in it are our messages.
  std::map<std::string, int> channels;
  EventLog log(log_);
  for (LogEvent e; log.next(e);) ++channels[e.channel];
  for (const char* name : {"RENDER_FRAME", "HAPTIC_PROBLEM", "DEVICE_STATE", "HAPTIC_STATUS", "SCENE_INFO"})
    EXPECT_GT(channels[name], 0) << name;

  start_gateway();
  const Page page([this] { return port_; });
  ASSERT_TRUE(wait_for([&] { return page.connections() == 1; }));
  int problems = 0;
  LcmBus listen(url_);
  listen.subscribe(channel::haptic_problem, [&](Bytes) { ++problems; });
  Tool ours({insula_, "replay", log_.string(), "--speed", "2"});
  EXPECT_EQ(ours.end().status, 0) << ours.said;
  EXPECT_TRUE(wait_for([&] { return page.frames(recorded_).size() > 100; })) << ours.said;
  EXPECT_EQ(http_status(port_, "/bundle/" + std::to_string(recorded_) + "/scene.json"), 200u);
  while (listen.poll(10) > 0) {
  }
  EXPECT_EQ(problems, 0) << "a hand may be on this bus";

  const std::size_t seen = page.frames(recorded_).size();
  gateway_->end(SIGTERM);
  start_gateway();  // knows nothing of the session
  ASSERT_TRUE(wait_for([&] { return page.connections() >= 2; }));
  Tool theirs({player, "--speed=2", "--lcm-url=" + url_, log_.string()});
  theirs.end();
  EXPECT_TRUE(wait_for([&] { return page.frames(recorded_).size() >= seen; })) << theirs.said;
  EXPECT_EQ(http_status(port_, "/bundle/" + std::to_string(recorded_) + "/scene.json"), 200u);
}

TEST_F(Replay, AMovedRecordingBringsItsBundleAndADamagedLogIsSaid) {
  const fs::path there = session_.folder() / "elsewhere";
  fs::rename(log_.parent_path(), there);
  start_gateway();
  Tool moved({insula_, "replay", (there / "session.lcmlog").string(), "--speed", "20"});
  EXPECT_EQ(moved.end().status, 0) << moved.said;
  EXPECT_TRUE(
      wait_for([&] { return http_status(port_, "/bundle/" + std::to_string(recorded_) + "/scene.json") == 200; }));

  fs::resize_file(there / "session.lcmlog", fs::file_size(there / "session.lcmlog") - 10);
  Tool cut({insula_, "replay", (there / "session.lcmlog").string(), "--speed", "1000"});
  EXPECT_EQ(cut.end().status, 2);
  EXPECT_NE(cut.said.find("the log ends within an event"), std::string::npos) << cut.said;
  fs::remove_all(there / std::to_string(recorded_));
  Tool bare({insula_, "replay", (there / "session.lcmlog").string(), "--speed", "1000"});
  bare.end();
  EXPECT_NE(bare.said.find("is gone: viewers have no geometry"), std::string::npos) << bare.said;
}

}  // namespace
}  // namespace insula
