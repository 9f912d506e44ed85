// SPDX-License-Identifier: GPL-3.0-or-later
// Start and end of tests of a running session.
#pragma once
#include <memory>

#include "tests/process/forces.h"
#include "tests/process/play_session.h"

namespace insula::testing {

/// A session that runs when the test begins. At its end, all observed forces must have kept the gate's slew limit.
class LiveSession : public ::testing::Test {
 protected:
  void SetUp() override {
    if (!multicast_works()) GTEST_SKIP() << "no multicast on this machine";
    session_ = std::make_unique<PlaySession>();
    std::vector<std::string> options{"--report", reports().string()};
    prepare(options);
    ASSERT_EQ(session_->start(options), "");
    watcher_ = std::make_unique<Watcher>(session_->url());
    ASSERT_TRUE(wait_for([&] {
      return session_->port() > 0 && watcher_->frames_now() > 20 && watcher_->last() && watcher_->status().rows >= 0;
    })) << session_->log();
  }
  void TearDown() override {
    if (!watcher_) return;
    expect_slew_limit(watcher_->samples());
    if (HasFailure()) std::fputs(session_->log().c_str(), stderr);
  }

  /// Before the session starts: may change its files and its options.
  virtual void prepare(std::vector<std::string>&) {}
  fs::path reports() const { return session_->folder() / "reports"; }
  /// Number of complete report folders of this session.
  int reports_written() const {
    int n = 0;
    std::error_code none;
    for (const auto& entry : fs::directory_iterator(reports(), none))
      n += fs::is_regular_file(entry.path() / "report.html") && fs::is_regular_file(entry.path() / "report.json");
    return n;
  }

  std::unique_ptr<PlaySession> session_;
  std::unique_ptr<Watcher> watcher_;
};

}  // namespace insula::testing
