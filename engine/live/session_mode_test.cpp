// SPDX-License-Identifier: GPL-3.0-or-later
// A session waits until somebody chooses what it is for, and then starts from the beginning.
#include "engine/live/session_mode.h"

#include "engine/live/engine_for_test.h"

namespace insula {
namespace {

/// An engine of a scene with an empty exercise.
class WaitingSession : public test::RunningEngine {
 protected:
  WaitingSession() { start(R"(<scene time_step="10 ms"><exercise id="e" title="E"/></scene>)", SessionMode::waiting); }
};

TEST_F(WaitingSession, TimeStandsUntilAModeIsChosen) {
  ASSERT_TRUE(eventually([&] { return frames_ > 20; }));
  EXPECT_EQ(mode(), "waiting");
  EXPECT_EQ(time_s_, 0);
  ask("begin", "demonstration");
  EXPECT_TRUE(eventually([&] { return !events_.empty(); }));
  EXPECT_EQ(events_.front().kind, "refused") << "the scene has no motion to show";
  EXPECT_EQ(mode(), "waiting");
  ask("begin", "test");
  ASSERT_TRUE(eventually([&] { return mode() == "test" && time_s_ > 0.2; }));
  ask("begin", "practice");
  ASSERT_TRUE(eventually([&] { return mode() == "practice"; }));
  EXPECT_LT(time_s_, 0.2) << "it starts again";
  ask("read", "Look there");
  EXPECT_TRUE(eventually([&] { return events_.back().kind == "read" && events_.back().text == "Look there"; }));
}

TEST(SessionMode, HasNames) {
  EXPECT_EQ(name_of(SessionMode::demonstration), "demonstration");
  EXPECT_EQ(session_mode("practice"), SessionMode::practice);
  EXPECT_EQ(session_mode("play"), std::nullopt);
  EXPECT_EQ(session_mode(""), std::nullopt);
}

}  // namespace
}  // namespace insula
