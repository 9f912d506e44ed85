// SPDX-License-Identifier: GPL-3.0-or-later
// The observer against closed forms: a spring gives back what was put in, held or late it gives more, by how much is
// known.
#include "haptic_server/passivity.h"

#include <gtest/gtest.h>

#include <cmath>

namespace insula {
namespace {

constexpr double k = 500, dt = 1e-3;

/// A hand that goes into a spring at constant speed and comes out again; the force on it is that of `late` ticks ago.
double in_and_out(int late) {
  PassivityObserver observer;
  constexpr int n = 200;
  constexpr double v = 0.02;
  const auto depth = [](int i) { return i < 0 ? 0.0 : v * dt * (i <= n ? i : 2 * n - i); };
  for (int i = 0; i <= 2 * n; ++i) observer.observe(Vec3(0, 0, k * depth(i - late)), Vec3(0, 0, -depth(i)));
  return observer.given();
}

TEST(PassivityObserver, CountsWhatALateSpringGives) {
  // Each tick's force does its work over the tick's displacement.
  const double step2 = 0.02 * dt * 0.02 * dt;
  const auto by_hand = [&](int late) {
    double sum = 0;
    const auto depth = [](int i) { return i < 0 ? 0.0 : double(i <= 200 ? i : 400 - i); };
    for (int i = 1; i <= 400; ++i) sum += depth(i - late) * (depth(i - 1) - depth(i));
    return k * step2 * sum;
  };
  for (int late : {1, 2, 3, 16}) {
    EXPECT_NEAR(in_and_out(late), by_hand(late), 1e-15) << late;
    EXPECT_GT(in_and_out(late), 0) << late;
  }
  // With the mean of the forces at both ends of a tick nothing is left over: half a tick early and half a tick late.
  EXPECT_NEAR(in_and_out(0) + in_and_out(1), 0, 1e-15);
}

TEST(PassivityObserver, AHandThatPutsInIsOwed) {
  PassivityObserver observer;
  for (int i = 0; i < 100; ++i) observer.observe(Vec3(0, 0, k * 1e-5 * i), Vec3(0, 0, -1e-5 * i));
  // Half k x^2 and the last half tick.
  EXPECT_NEAR(observer.given(), -k * 1e-10 * (99 * 100 / 2), 1e-15);
  EXPECT_EQ(observer.most(), 0);
}

TEST(PassivityObserver, BeginsAnewInFreeAirAndIgnoresWhatIsNoNumber) {
  PassivityObserver observer;
  observer.observe(Vec3(0, 0, 1), Vec3::Zero());
  observer.observe(Vec3(0, 0, 1), Vec3(0, 0, 1e-3));
  EXPECT_DOUBLE_EQ(observer.given(), 1e-3);
  observer.observe(Vec3(0, 0, std::nan("")), Vec3(0, 0, 2e-3));
  EXPECT_DOUBLE_EQ(observer.given(), 1e-3);
  for (int i = 0; i < 60; ++i) observer.observe(Vec3::Zero(), Vec3(0, 0, 2e-3 + i * 1e-3));
  EXPECT_EQ(observer.given(), 0);
  EXPECT_DOUBLE_EQ(observer.most(), 1e-3);
}

}  // namespace
}  // namespace insula
