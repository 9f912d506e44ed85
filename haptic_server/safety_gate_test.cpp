// SPDX-License-Identifier: GPL-3.0-or-later
// The safety gate: finite, limited, slew-limited whatever comes in; ramps in time.
#include "haptic_server/safety_gate.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "core/testing/held.h"
#include "haptic_server/devices/arm_model.h"
#include "haptic_server/problem_for_test.h"
#include "tests/figures/figure.h"

namespace insula {
namespace {

constexpr double dt = 1e-3;
const Vec3 none = Vec3::Zero();

DeviceProfile with_torque() {
  DeviceProfile p = omni_profile();
  p.max_torque_Nm = 0.5;
  p.max_slew_Nm_s = 10;
  return p;
}

/// Ticks until |force| first reaches `size`, at most `most`.
int ticks_until(SafetyGate& gate, const Vec3& wanted, double size, int most) {
  for (int k = 1; k <= most; ++k) {
    gate.apply(dt, true, wanted, none);
    if (gate.force().norm() >= size) return k;
  }
  return -1;
}

TEST(SafetyGate, GarbageNeverGetsThrough) {
  testing::Random random(11);
  const DeviceProfile profile = with_torque();
  SafetyGate gate(profile);
  const double odd[] = {std::numeric_limits<double>::quiet_NaN(),
                        std::numeric_limits<double>::infinity(),
                        -1e308,
                        1e308,
                        std::numeric_limits<double>::denorm_min(),
                        0.0,
                        1e200,
                        -1e154};
  Vec3 last_force = none, last_torque = none;
  long pushed = 0;
  double most = 0, max_change = 0;
  auto number = [&] {
    const double scale = std::pow(10.0, 6 * random.next());
    return random.bits() % 16 == 0 ? odd[random.bits() % 8] : scale * random.next();
  };
  bool live = false, noise = true;
  Vec3 steady = none;
  for (int tick = 0; tick < 1'000'000; ++tick) {
    if (random.bits() % 400 == 0) live = !live;
    if (random.bits() % 500 == 0) {  // pure noise, or a force large enough to reach the limit with noise now and then
      noise = !noise;
      steady = random.vector(50);
    }
    const double elapsed =
        random.bits() % 64 == 0 ? (random.bits() % 2 ? 10.0 : odd[random.bits() % 8]) : dt * (1 + 0.5 * random.next());
    Vec3 force = steady, torque = 0.1 * steady;
    for (int i = 0; i < 3 && (noise || random.bits() % 1000 == 0); ++i) {
      force[i] = number();
      torque[i] = number();
    }
    gate.apply(elapsed, live, force, torque);
    const Vec3 f = gate.force(), t = gate.torque();
    ASSERT_TRUE(f.allFinite() && t.allFinite()) << tick;
    most = std::max(most, f.norm() - profile.max_force_N);
    max_change = std::max(max_change,
                          (f - last_force).norm() -
                              profile.max_slew_N_s * (elapsed > 0 ? std::min(elapsed, SafetyGate::longest_tick_s) : 0));
    ASSERT_LE(f.norm(), profile.max_force_N * (1 + 1e-12)) << tick;
    ASSERT_LE(t.norm(), profile.max_torque_Nm * (1 + 1e-12)) << tick;
    // No elapsed time (or none that makes sense): no change at all.
    const double counted = elapsed > 0 ? std::min(elapsed, SafetyGate::longest_tick_s) : 0;
    ASSERT_LE((f - last_force).norm(), profile.max_slew_N_s * counted + 1e-12) << tick;
    ASSERT_LE((t - last_torque).norm(), profile.max_slew_Nm_s * counted + 1e-12) << tick;
    last_force = f;
    last_torque = t;
    pushed += f.norm() > 1;
  }
  EXPECT_TRUE(test::held("garbage beyond the device's force", most, profile.max_force_N, 1e-12));
  EXPECT_TRUE(test::held("garbage beyond its change of force, N", max_change, 1, 1e-12));
  EXPECT_GT(pushed, 10'000);  // it was not simply shut
  EXPECT_GT(gate.refused(), 0);
}

TEST(SafetyGate, RampsInOverAQuarterSecond) {
  SafetyGate gate(omni_profile());
  const Vec3 wanted(0, 0, 1);
  test::Figure figure("gate", "The safety gate: a source comes, and goes", "time, ms", "force on the hand, N");
  for (int k = 1; k <= 250; ++k) {
    gate.apply(dt, true, wanted, none);
    EXPECT_TRUE(test::held("the gate on its way in, N", std::abs(gate.force().z() - k / 250.0), 1, 1e-9));
    if (k % 10 == 0) figure.run("gate", k, gate.force().z());
  }
  for (const auto& [t, f] : {std::pair{0.0, 0.0}, std::pair{250.0, 1.0}, std::pair{400.0, 1.0}, std::pair{450.0, 0.0},
                             std::pair{500.0, 0.0}})
    figure.law("250 ms in, 50 ms out", t, f);
  for (int k = 251; k <= 400; ++k) {
    gate.apply(dt, true, wanted, none);
    EXPECT_EQ(gate.force().z(), 1);
    if (k % 10 == 0) figure.run("gate", k, gate.force().z());
  }
  for (int k = 1; k <= 100; ++k) {
    gate.apply(dt, false, wanted, none);
    EXPECT_NEAR(gate.force().z(), std::max(0.0, 1 - k / 50.0), 1e-9);
    if (k % 5 == 0) figure.run("gate", 400 + k, gate.force().z());
  }
}

TEST(SafetyGate, ClampsTheVectorAndKeepsItsDirection) {
  SafetyGate gate(omni_profile());
  const Vec3 wanted(300, -400, 0);
  EXPECT_GT(ticks_until(gate, wanted, 3.3 - 1e-9, 1000), 0);
  gate.apply(dt, true, wanted, none);
  EXPECT_NEAR((gate.force() - 3.3 * Vec3(0.6, -0.8, 0)).norm(), 0, 1e-9);
}

TEST(SafetyGate, RampsOutToExactlyZeroWithin50ms) {
  for (double size : {0.01, 1.0, 3.3}) {
    SafetyGate gate(omni_profile());
    for (int k = 0; k < 500; ++k) gate.apply(dt, true, Vec3(size, 0, 0), none);
    ASSERT_NEAR(gate.force().x(), size, 1e-12);
    for (int k = 1; k <= 50; ++k) {
      gate.apply(dt, false, Vec3(size, 0, 0), none);
      EXPECT_TRUE(
          test::held("the gate on its way out, N", std::abs(gate.force().x() - size * (50 - k) / 50.0), 1, 1e-9))
          << size;
    }
    EXPECT_EQ(gate.force(), none);
    for (int k = 0; k < 100; ++k) {
      gate.apply(dt, false, Vec3(size, 0, 0), none);
      EXPECT_EQ(gate.force(), none);
    }
  }
}

TEST(SafetyGate, ReturnsGentlyAfterALoss) {
  SafetyGate gate(omni_profile());
  for (int k = 0; k < 500; ++k) gate.apply(dt, true, Vec3(2, 0, 0), none);
  for (int k = 0; k < 60; ++k) gate.apply(dt, false, none, none);
  for (int k = 1; k <= 125; ++k) gate.apply(dt, true, Vec3(2, 0, 0), none);
  EXPECT_NEAR(gate.force().x(), 1, 1e-9);
}

TEST(SafetyGate, ReversalTakesTheSlewLimitsTime) {
  SafetyGate gate(omni_profile());
  for (int k = 0; k < 500; ++k) gate.apply(dt, true, Vec3(3.3, 0, 0), none);
  int ticks = 0;
  while (gate.force().x() > -3.3 + 1e-9 && ticks < 1000) {
    gate.apply(dt, true, Vec3(-3.3, 0, 0), none);
    ++ticks;
  }
  EXPECT_EQ(ticks, 100);  // 6.6 N at 66 N/s
}

TEST(SafetyGate, NonFiniteCountsAsALostSource) {
  SafetyGate gate(omni_profile());
  for (int k = 0; k < 500; ++k) gate.apply(dt, true, Vec3(1, 0, 0), none);
  for (int k = 0; k < 50; ++k) gate.apply(dt, true, Vec3(1, NAN, 0), none);
  EXPECT_EQ(gate.force(), none);
  EXPECT_EQ(gate.refused(), 50);
}

TEST(SafetyGate, LimitsThatMakeNoSenseShutIt) {
  DeviceProfile p = omni_profile();
  p.max_force_N = std::numeric_limits<double>::quiet_NaN();
  SafetyGate gate(p);
  for (int k = 0; k < 500; ++k) gate.apply(dt, true, Vec3(1, 1, 1), Vec3(1, 1, 1));
  EXPECT_EQ(gate.force(), none);
  EXPECT_EQ(gate.torque(), none);  // the Omni gives no torques
}

}  // namespace
}  // namespace insula
