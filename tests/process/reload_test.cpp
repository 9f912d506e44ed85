// SPDX-License-Identifier: GPL-3.0-or-later
// A session whose scene is saved while hands press: a good scene takes over without a jump of force, a bad one is told
// to the viewers and changes nothing.
#include "tests/process/live_session.h"

namespace insula {
namespace {

using namespace testing;

class Reload : public LiveSession {
 protected:
  void SetUp() override {
    LiveSession::SetUp();
    if (IsSkipped() || HasFatalFailure()) return;
    bus_ = std::make_unique<LcmBus>(session_->url());
    bus_->subscribe(channel::scene_info, [this](Bytes b) {
      if (const auto m = decode<insula_lcm::scene_info_t>(b)) info_ = *m;
    });
  }
  std::string text() const {
    std::ifstream in(scene());
    return {std::istreambuf_iterator<char>(in), {}};
  }
  fs::path scene() const { return session_->folder() / "press.xml"; }
  void save(const std::string& from, const std::string& to) const {
    std::string all = text();
    const std::size_t at = all.find(from);
    ASSERT_NE(at, std::string::npos);
    all.replace(at, from.size(), to);
    std::ofstream(scene()) << all;
  }
  /// Until the engine says so; looks at the bus.
  template <class Condition>
  bool heard(Condition condition) {
    return wait_for([&] {
      bus_->poll(20);
      return condition(info_);
    });
  }

  std::unique_ptr<LcmBus> bus_;
  insula_lcm::scene_info_t info_{};
};

TEST_F(Reload, GoodAndBadSaves) {
  ASSERT_TRUE(watcher_->press(0.1)) << watcher_->force();
  const std::int64_t first = watcher_->frame_session(), server = watcher_->last()->session;
  // Something wrong: told with its place, and the engine goes on.
  save("title=\"Press\"", "title=\"Press\" gravty=\"1 N\"");
  ASSERT_TRUE(heard([](const auto& i) {
    return i.message.find("press.xml:1:") != std::string::npos &&
           i.message.find("did you mean \"gravity\"?") != std::string::npos;
  })) << info_.message;
  EXPECT_EQ(info_.state, "running");
  EXPECT_EQ(info_.session, first);
  // Half a file is an error like any other, and told instead of the one before.
  const std::string whole = text();
  std::ofstream(scene()) << whole.substr(0, whole.size() / 2);
  ASSERT_TRUE(heard([](const auto& i) { return !i.message.empty() && i.message.find("gravty") == std::string::npos; }));
  EXPECT_EQ(watcher_->frame_session(), first);
  // Put right: a new run of the new scene, the message is gone, server and hands have stayed.
  std::ofstream(scene()) << whole;
  save("title=\"Press\" gravty=\"1 N\"", "title=\"Pressed again\"");
  ASSERT_TRUE(
      heard([&](const auto& i) { return i.session != first && i.title == "Pressed again" && i.message.empty(); }));
  ASSERT_TRUE(wait_for([&] { return watcher_->frame_session() != first && watcher_->frames_now() > 20; }));
  EXPECT_EQ(watcher_->last()->session, server);
  EXPECT_TRUE(watcher_->press(0.1)) << "no force after the scene was loaded again: " << watcher_->force();
  EXPECT_EQ(session_->count("[engine] error"), 0);
  EXPECT_EQ(reports_written(), 1) << "of the scene before; the new one's comes at its end";
}

}  // namespace
}  // namespace insula
