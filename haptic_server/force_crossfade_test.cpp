// SPDX-License-Identifier: GPL-3.0-or-later
// From problem to problem: within 15 ms, slower the larger, and nothing of it once a hand is lost.
#include "haptic_server/force_crossfade.h"

#include <gtest/gtest.h>

#include <limits>

#include "haptic_server/problem_for_test.h"
#include "haptic_server/servo.h"

namespace insula {
namespace {

constexpr double tick_s = 1e-3;

Vec6 push(double newtons) { return newtons * Vec6::Unit(2); }

struct Hand {
  ForceCrossfadeSettings settings{.within_s = 0.015};
  ForceCrossfade over;
  double last = 0;
  double tick(double force, bool fresh = false) { return last = over(settings, fresh, push(force), tick_s)[2]; }
  /// Ticks until the rendered force is the problem's force, and the largest change until then.
  int settle(double force, double& most) {
    for (int k = 1; k < 1000; ++k) {
      const double before = last;
      tick(force);
      most = std::max(most, std::abs(last - before));
      if (std::abs(last - force) < 1e-12) return k;
    }
    return 1000;
  }
};

TEST(ForceCrossfade, ASmallChangeTakes15ms) {
  Hand h;
  h.tick(0.2, true);
  EXPECT_NEAR(h.tick(0.21, true), 0.2 + 0.01 / 15, 1e-12);  // from the first tick on
  double most = 0;
  EXPECT_NEAR(h.settle(0.21, most), 15, 1);
  EXPECT_NEAR(most, 0.01 / 15, 1e-9);
}

TEST(ForceCrossfade, ALargeOneIsLimitedInSlope) {
  Hand h;
  h.tick(0.2, true);
  h.tick(0, true);
  double most = 0;
  EXPECT_NEAR(h.settle(0, most), 100, 3);
  EXPECT_LE(most, 0.01 * 0.2 + 1e-12);
  // And where nothing was felt before, by what no hand tells.
  Hand first;
  first.tick(0, true);
  first.tick(5e-3, true);
  most = 0;
  first.settle(5e-3, most);
  EXPECT_LE(most, 0.2e-3 + 1e-12);
}

TEST(ForceCrossfade, TheProblemsOwnChangesPassAtOnce) {
  Hand h;
  h.tick(0.2, true);
  h.tick(0.1, true);
  const double before = h.tick(0.1);
  EXPECT_NEAR(h.tick(0.05) - before, -0.05, 0.003);
}

TEST(ForceCrossfade, WhatComesByItselfNeedNotBeHandedOver) {
  // Each problem strays by 50 mN in 10 ms and the next one puts that right: what is felt lies between and goes nowhere.
  Hand h;
  double least = 1, most = 0;
  for (int k = 0; k < 500; ++k) {
    h.tick(0.3 - 5e-3 * (k % 10), k % 10 == 0);
    if (k < 100) continue;
    least = std::min(least, h.last);
    most = std::max(most, h.last);
  }
  EXPECT_GE(least, 0.25 - 1e-9);
  EXPECT_LE(most, 0.3 + 1e-9);
}

TEST(ForceCrossfade, ALostHandIsLostAtOnce) {
  ConstraintProblem p = testing::two_tool_problem(10, 10, 3);
  testing::solve_as_engine(p);
  Servo servo(ServoSettings::beyond_equation_7());
  ServoInput in;
  for (const ToolTerms& t : p.tools) in.device[std::size_t(t.hand)] = t.device;
  in.connected = {true, true};
  servo.set_problem(&p, {}, tick_s);
  ASSERT_GT(servo.tick(in).hand[1].force.norm(), 1e-3);
  // In the middle of a force cross-fade: the source ends, a device goes, a device jumps away.
  ConstraintProblem other = p;
  for (double& d : other.delta_free) d += 1e-3;
  servo.set_problem(&other, {}, tick_s);
  ASSERT_TRUE(servo.tick(in).hand[1].valid);
  in.connected[1] = false;
  ServoResult r = servo.tick(in);
  EXPECT_FALSE(r.hand[1].valid);
  EXPECT_EQ(r.hand[1].force.norm(), 0);
  in.connected[1] = true;
  in.device[1].p.x() += 1;
  r = servo.tick(in);
  EXPECT_FALSE(r.hand[1].valid);
  EXPECT_EQ(r.hand[1].force.norm(), 0);
  servo.set_problem(nullptr);
  r = servo.tick(in);
  for (const ServoHand& hand : r.hand) {
    EXPECT_FALSE(hand.valid);
    EXPECT_EQ(hand.force.norm(), 0);
  }
}

}  // namespace
}  // namespace insula
