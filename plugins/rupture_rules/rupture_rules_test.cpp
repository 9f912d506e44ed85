// SPDX-License-Identifier: GPL-3.0-or-later
// The rules of a rupture against step reports made by hand.
#include <gtest/gtest.h>

#include "core/testing/example.h"

namespace insula {
namespace {

const std::filesystem::path example = std::filesystem::path(INSULA_SOURCE_DIR) / "plugins/rupture_rules/example.xml";
constexpr double ml_per_min = 1e-6 / 60;

class RuptureRules : public ::testing::Test {
 protected:
  void SetUp() override {
    s = test::load(example);
    ASSERT_TRUE(s && s->exercise());
    report.h = 0.05;
    report.bleeding.resize(1);
    report.clips.resize(2);
    report.clips[1].temporary = true;
  }
  void show(double seconds) {
    for (double t = 0; t < seconds - 1e-9; t += report.h) {
      report.time += report.h;
      s->exercise()->log().events.clear();
      s->exercise()->observe(report);
      report.events.clear();
    }
  }
  void rupture() {
    report.bleeding[0] = {true, 40 * ml_per_min, 0, 0, Vec3::Zero(), Vec3::UnitZ(), 0.01, report.time};
    report.events.push_back({"rupture", "bleb", "", 0, report.time});
  }
  void put(int clip, bool on) { report.clips[std::size_t(clip)].on_tray = !on; }
  const ExerciseLog& log() { return s->exercise()->log(); }
  bool done(const std::string& id) {
    for (const GoalState& g : log().goals())
      if (g.id == id) return g.done;
    throw std::runtime_error("no goal " + id);
  }
  int faults(const std::string& id) {
    for (const FaultState& f : log().faults())
      if (f.id == id) return f.count;
    throw std::runtime_error("no fault " + id);
  }
  const TimerState& timer(const std::string& id) {
    for (const TimerState& t : log().timers())
      if (t.id == id) return t;
    throw std::runtime_error("no timer " + id);
  }
  std::unique_ptr<Simulation> s;
  StepReport report;
};

TEST_F(RuptureRules, NothingHappensBeforeTheRupture) {
  show(20);
  EXPECT_FALSE(done("stop"));
  EXPECT_EQ(faults("burst"), 0);
  EXPECT_EQ(timer("clock").elapsed, 0);
  EXPECT_EQ(log().state(), ExerciseState::running);
}

TEST_F(RuptureRules, MasteredInOrder) {
  show(1);
  rupture();
  show(1);
  EXPECT_EQ(faults("burst"), 1);
  EXPECT_NEAR(timer("clock").elapsed, 1, 1e-9);
  EXPECT_TRUE(timer("clock").running);
  put(1, true);
  report.bleeding[0].rate = 0.1 * ml_per_min;
  show(0.15);
  EXPECT_FALSE(done("stop")) << "too short";
  show(0.1);
  EXPECT_TRUE(done("stop"));
  EXPECT_TRUE(timer("occlusion").running);
  put(0, true);
  show(1);
  EXPECT_FALSE(done("removed")) << "the temporary clip is still on";
  EXPECT_TRUE(timer("clock").running);
  put(1, false);
  show(0.05);
  EXPECT_TRUE(done("removed"));
  EXPECT_FALSE(timer("occlusion").running);
  EXPECT_EQ(faults("occlusion_over"), 0);
  EXPECT_EQ(log().state(), ExerciseState::done);
}

TEST_F(RuptureRules, BleedingAgainTakesTheGoalBack) {
  rupture();
  show(0.1);
  report.bleeding[0].rate = 0;
  show(0.5);
  EXPECT_TRUE(done("stop"));
  report.bleeding[0].rate = 10 * ml_per_min;
  show(0.15);
  EXPECT_FALSE(done("stop"));
}

TEST_F(RuptureRules, SpurtsTakeNothingBackButBloodThatRunsDoes) {
  rupture();
  put(0, true);
  put(1, true);
  report.bleeding[0].rate = 0;
  show(0.05);
  put(1, false);
  show(0.05);
  ASSERT_TRUE(done("removed"));
  ASSERT_FALSE(done("stop")) << "so that the exercise goes on";
  // One step above the limit of 1 ml/min, two below: how often the goal is lost over twenty seconds.
  const auto spurts = [&](double rate) {
    int lost = 0;
    for (int beat = 0; beat < 133; ++beat)
      for (const double now : {rate, 0.5, 0.5}) {
        const bool had = done("removed");
        report.bleeding[0].rate = now * ml_per_min;
        show(0.05);
        lost += had && !done("removed");
      }
    return lost;
  };
  EXPECT_EQ(spurts(1.8), 0) << "0.93 ml/min in the mean";
  EXPECT_FALSE(timer("clock").running);
  EXPECT_EQ(spurts(2.5), 1) << "1.17 ml/min in the mean: lost once, not with every beat";
  EXPECT_FALSE(done("removed"));
  EXPECT_TRUE(timer("clock").running);
}

TEST_F(RuptureRules, AStoppedBleedingMaySpurt) {
  rupture();
  report.bleeding[0].rate = 0;
  show(0.3);
  ASSERT_TRUE(done("stop"));
  for (int beat = 0; beat < 8; ++beat) {
    report.bleeding[0].rate = 10 * ml_per_min;
    show(0.05);
    EXPECT_TRUE(done("stop")) << beat;
    report.bleeding[0].rate = 0;
    show(0.95);
  }
}

TEST_F(RuptureRules, TooLongOcclusionIsOneFault) {
  rupture();
  put(1, true);
  report.bleeding[0].rate = 0;
  show(2.9);
  EXPECT_EQ(faults("occlusion_over"), 0);
  show(3);
  EXPECT_EQ(faults("occlusion_over"), 1);
  put(1, false);
  show(0.1);
  EXPECT_EQ(timer("occlusion").elapsed, 0);
  put(1, true);
  show(3.2);
  EXPECT_EQ(faults("occlusion_over"), 2) << "a second occlusion counts anew";
}

TEST_F(RuptureRules, TimeRunsOut) {
  rupture();
  show(9.9);
  EXPECT_EQ(log().state(), ExerciseState::running);
  show(0.3);
  EXPECT_EQ(log().state(), ExerciseState::failed);
}

TEST_F(RuptureRules, AHeldClipIsNotOn) {
  rupture();
  put(1, true);
  report.clips[1].holder = s->bodies().front();
  show(1);
  EXPECT_FALSE(timer("occlusion").running);
}

}  // namespace
}  // namespace insula
