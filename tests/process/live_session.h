// SPDX-License-Identifier: GPL-3.0-or-later
// What tests of a running session begin and end with.
#pragma once
#include <memory>

#include "tests/process/forces.h"
#include "tests/process/play_session.h"

namespace insula::testing {

/// A session that runs when the test begins; when it ends, all forces that were seen must have kept the gate's limit of change.
class LiveSession : public ::testing::Test {
 protected:
  void SetUp() override {
    if (!multicast_works()) GTEST_SKIP() << "no multicast on this machine, and no rights to add a route";
    session_ = std::make_unique<PlaySession>();
    ASSERT_EQ(session_->start(), "");
    watcher_ = std::make_unique<Watcher>(session_->url());
    ASSERT_TRUE(wait_for([&] { return session_->port() > 0 && watcher_->frames_now() > 20 && watcher_->last() && watcher_->status().rows >= 0; })) << session_->log();
  }
  void TearDown() override {
    if (!watcher_) return;
    expect_slew_limit(watcher_->samples());
    if (HasFailure()) std::fputs(session_->log().c_str(), stderr);
  }

  std::unique_ptr<PlaySession> session_;
  std::unique_ptr<Watcher> watcher_;
};

}  // namespace insula::testing
