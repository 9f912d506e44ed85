// SPDX-License-Identifier: GPL-3.0-or-later
// Goals of simulated hands: steady, limited in speed, taken over and handed back.
#include "haptic_server/hand_guide.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

namespace insula {
namespace {

constexpr double guide_tick = 1e-3;

TEST(HandGuide, FollowsAScriptWithItsVelocity) {
  HandGuide guide;
  guide.place(Pose());
  HandSample wish;
  for (int k = 1; k <= 100; ++k) {
    wish.pose.p.x() = 0.05 * guide_tick * k;
    wish.button1 = k > 50;
    const HandGoal& g = guide.advance(guide_tick, wish);
    EXPECT_EQ(g.pose.p, wish.pose.p);
    EXPECT_NEAR(g.v.x(), 0.05, 1e-9);
    EXPECT_EQ(g.button1, k > 50);
    EXPECT_TRUE(g.stops);
  }
}

TEST(HandGuide, WalksWhereTheWishJumps) {
  const GuideSettings s;
  HandGuide guide(s);
  guide.place(Pose());
  HandSample wish;
  wish.pose.p = Vec3(0.03, 0, 0.04);
  wish.pose.q = from_rotation_vector(Vec3(0, 2, 0));
  Pose last;
  int ticks = 0;
  for (; ticks < 1000; ++ticks) {
    const HandGoal& g = guide.advance(guide_tick, wish);
    const Vec6 d = displacement(last, g.pose);
    ASSERT_LE(d.head<3>().norm(), s.max_speed_m_s * guide_tick * (1 + 1e-9));
    ASSERT_LE(d.tail<3>().norm(), s.max_spin_rad_s * guide_tick * (1 + 1e-9));
    last = g.pose;
    if ((g.pose.p - wish.pose.p).norm() == 0 && displacement(g.pose, wish.pose).tail<3>().norm() == 0) break;
  }
  EXPECT_NEAR(ticks, 2 / s.max_spin_rad_s / guide_tick, 2);  // the turn takes longest
}

TEST(HandGuide, AViewerTakesOverUntilPlaced) {
  HandGuide guide;
  guide.place(Pose());
  HandSample viewer, script;
  viewer.pose.p = Vec3(0.01, 0, 0);
  viewer.button2 = true;
  script.pose.p = Vec3(-0.01, 0, 0);
  for (int k = 0; k < 1000; ++k) {
    if (k % 50 == 0) guide.take_over(viewer);
    guide.advance(guide_tick, script);
  }
  EXPECT_NEAR((guide.goal().pose.p - viewer.pose.p).norm(), 0, 1e-9);
  EXPECT_TRUE(guide.goal().button2);
  EXPECT_FALSE(guide.goal().stops);
  guide.place(Pose());
  for (int k = 0; k < 1000; ++k) {
    if (k % 50 == 0) guide.take_over(viewer);  // the same stream goes on and is not heard
    guide.advance(guide_tick, script);
  }
  EXPECT_EQ(guide.goal().pose.p, script.pose.p);
  EXPECT_FALSE(guide.goal().button2);
  for (int k = 0; k < 200; ++k) guide.advance(guide_tick, script);  // a pause
  guide.take_over(viewer);
  EXPECT_TRUE(guide.advance(guide_tick, script).button2);
}

/// Runs until the goal has come to rest. Checks that nothing jumps, and returns the number of ticks.
int ticks_of_the_way_back(HandGuide& guide, const HandSample& script, const GuideSettings& s) {
  Pose last = guide.goal().pose;
  Vec3 v = Vec3::Zero();
  for (int k = 0; k < 20000; ++k) {
    const HandGoal& g = guide.advance(guide_tick, script);
    if (g.stops) return k;
    const Vec6 d = displacement(last, g.pose);
    EXPECT_LE(d.head<3>().norm(), s.return_speed_m_s * guide_tick * (1 + 1e-9));
    EXPECT_LE(d.tail<3>().norm(), s.return_spin_rad_s * guide_tick * (1 + 1e-9));
    // It gathers speed over the ramp; only the arrival may stop it at once.
    if (k > 0 && (g.pose.p - script.pose.p).norm() > 1e-9) {
      EXPECT_LE((g.v - v).norm(), s.return_speed_m_s * guide_tick / s.return_ramp_s * (1 + 1e-6));
    }
    EXPECT_FALSE(g.button1 || g.button2);
    last = g.pose;
    v = g.v;
  }
  return 20000;
}

TEST(HandGuide, AReleasedHandGlidesBackWithItsButtonsOff) {
  const GuideSettings s;
  HandGuide guide(s);
  guide.place(Pose());
  HandSample viewer, script;
  viewer.pose.p = Vec3(0.02, 0, 0);
  viewer.button1 = viewer.button2 = true;
  script.pose.p = Vec3(0, 0, 0.03);
  for (int k = 0; k < 500; ++k) {
    guide.take_over(viewer);
    guide.advance(guide_tick, script);
  }
  guide.release();
  const int ticks = ticks_of_the_way_back(guide, script, s);
  // The way at full speed, and half of the ramp.
  const double way = Vec3(0.02, 0, 0.03).norm();
  EXPECT_NEAR(ticks * guide_tick, way / s.return_speed_m_s + 0.5 * s.return_ramp_s, 0.01);
  EXPECT_EQ(guide.goal().pose.p, script.pose.p);
}

TEST(HandGuide, AHandIsReleasedWhenItsViewerIsLost) {
  const GuideSettings s;
  HandGuide guide(s);
  guide.place(Pose());
  HandSample viewer;
  viewer.pose.p = Vec3(0.02, 0, 0);
  viewer.button1 = true;
  guide.take_over(viewer);
  int ticks = 0;
  while (guide.advance(guide_tick, HandSample{}).button1 && ticks < 5000) ++ticks;
  EXPECT_NEAR(ticks * guide_tick, s.lost_after_s, 2 * guide_tick);
  EXPECT_LT(ticks_of_the_way_back(guide, HandSample{}, s), 5000);
  EXPECT_EQ(guide.goal().pose.p, Vec3(Vec3::Zero()));
}

TEST(HandGuide, SmoothsSixtyPosesASecond) {
  HandGuide guide;
  guide.place(Pose());
  double fastest = 0;
  for (int k = 0; k < 1000; ++k) {
    if (k % 16 == 0) {
      HandSample s;
      s.pose.p.x() = 0.05 * guide_tick * k;  // steps of 0.8 mm
      guide.take_over(s);
    }
    guide.advance(guide_tick, HandSample{});
    if (k > 200) fastest = std::max(fastest, guide.goal().v.x());
  }
  EXPECT_LT(fastest, 0.08);  // a raw step would be 0.3 m/s, the limit
}

TEST(MotionClock, FollowsStepsSmoothly) {
  MotionClock clock;
  clock.reset(0);
  double last = 0, slowest = 1, fastest = 0;
  for (int k = 0; k < 2000; ++k) {
    if (k % 17 == 0) clock.step_arrived(k * guide_tick, 17 * guide_tick);
    const double t = clock.advance(guide_tick);
    ASSERT_GE(t, last);
    if (k > 500) {
      slowest = std::min(slowest, (t - last) / guide_tick);
      fastest = std::max(fastest, (t - last) / guide_tick);
      ASSERT_NEAR(t, (k + 1) * guide_tick, 2e-3);
    }
    last = t;
  }
  EXPECT_GT(slowest, 0.9);
  EXPECT_LT(fastest, 1.1);
}

TEST(MotionClock, StopsWithTheEngineAndFollowsASlowOne) {
  MotionClock clock;
  clock.reset(0);
  for (int k = 0; k < 500; ++k) {
    if (k % 17 == 0) clock.step_arrived(k * guide_tick, 17 * guide_tick);
    clock.advance(guide_tick);
  }
  for (int k = 0; k < 1000; ++k) clock.advance(guide_tick);  // no more steps
  EXPECT_LE(clock.time(), 0.5 + 17 * guide_tick + 1e-9);
  clock.reset(0);
  for (int k = 0; k < 4000; ++k) {  // at half speed
    if (k % 34 == 0) clock.step_arrived(0.5 * k * guide_tick, 17 * guide_tick);
    clock.advance(guide_tick);
  }
  EXPECT_NEAR(clock.time(), 2.0, 0.02);
}

TEST(Workspace, LiesOverTheMotion) {
  const Vec3 reach(0.160, 0.120, 0.070);
  Vec3 centre, extent;
  lay_workspace(nullptr, 0, Vec3(1, 2, 3), reach, centre, extent);
  EXPECT_EQ(centre, Vec3(1, 2, 3));
  EXPECT_EQ(extent, reach);
  Motion m;
  m.add(0, {0, {Pose{Vec3(0, 0, 0), Quat::Identity()}, false, false}});
  m.add(0, {1, {Pose{Vec3(0.01, 0.02, 0.09), Quat::Identity()}, false, false}});
  lay_workspace(&m, 0, Vec3(0, 0, 0.1), reach, centre, extent);
  EXPECT_NEAR((centre - Vec3(0.005, 0.01, 0.05)).norm(), 0, 1e-15);
  EXPECT_EQ(extent, Vec3(0.070, 0.120, 0.160));
}

}  // namespace
}  // namespace insula
