// SPDX-License-Identifier: GPL-3.0-or-later
// Metrics of both hands against closed forms, and what no metric may depend on: frame rate, start pose, side.
#include <numbers>

#include "core/testing/held.h"
#include "plugins/motion_metrics/made_motion_for_test.h"

namespace insula {
namespace {

using test::at;
using test::held;
using test::MadeMotion;
constexpr double pi = std::numbers::pi;

TEST(BimanualMetrics, SeparationOfASineAboutAFixedTip) {
  MadeMotion m(100);
  m.show(10 - 0.01, at([](double) { return Vec3(0, 0, 0); }),
         at([](double t) { return Vec3(0, 0.03 + 0.01 * std::sin(2 * pi * t), 0); }));
  EXPECT_TRUE(held("mean", std::abs(m.value("tip_separation", 2) - 0.03), 0.03, 1e-12));
  EXPECT_TRUE(held("smallest", std::abs(m.value("tip_separation_least", 2) - 0.02), 0.02, 1e-12));
  EXPECT_TRUE(held("change", std::abs(m.value("tip_separation_change", 2) - 0.01 * std::sqrt(0.5)), 0.01, 1e-9));
}

TEST(BimanualMetrics, SimultaneousUseIsTheShareOfTheWorkingTime) {
  MadeMotion m(100);
  const auto presses = [](double from, double to) {
    return [=](double t, HandReport& hand) { hand.button[0] = t > from - 0.005 && t < to - 0.005; };
  };
  m.show(10, presses(1, 5), presses(4, 9));  // 8 s of work, 1 s of it together
  EXPECT_NEAR(m.value("simultaneous_use", 2), 1 / 8.0, 1e-12);
}

TEST(BimanualMetrics, CoordinationIsTheCorrelationOfTheSpeeds) {
  const auto along = [](double sign) {  // speed 0.02 (1 + sign cos)
    return at([=](double t) { return Vec3(0.02 * (t + sign * std::sin(2 * pi * t) / (2 * pi)), 0, 0); });
  };
  const auto of = [&](const MadeMotion::HandAt& left, const MadeMotion::HandAt& right) {
    MadeMotion m(100);
    m.show(5, left, right);
    return m.value("coordination", 2);
  };
  EXPECT_NEAR(of(along(1), along(1)), 1, 1e-9);
  EXPECT_NEAR(of(along(1), along(-1)), -1, 1e-9);
  const auto quarter = at([](double t) { return Vec3(0.02 * (t - std::cos(2 * pi * t) / (2 * pi)), 0, 0); });
  EXPECT_NEAR(of(along(1), quarter), 0, 1e-9);
  EXPECT_TRUE(std::isnan(of(along(1), at([](double) { return Vec3(0, 0, 0); })))) << "a still hand has no correlation";
}

TEST(BimanualMetrics, DominanceComparesThePaths) {
  MadeMotion m(60);
  m.show(2, at([](double t) { return Vec3(0.01 * t, 0, 0); }), at([](double t) { return Vec3(0, 0.03 * t, 0); }));
  EXPECT_NEAR(m.value("dominance", 2), 0.5, 1e-12);
}

/// Two hands that reach, circle, turn, press and shake; placed and turned by `frame`.
struct Work {
  Pose frame;
  void operator()(MadeMotion& m, bool swapped = false) const {
    const auto put = [frame = frame](HandReport& hand, const Vec3& p, const Quat& q) {
      hand.device = hand.tip = {frame.apply(p), frame.q * q};
    };
    const MadeMotion::HandAt reaching = [put](double t, HandReport& hand) {
      const double s = t / 1.5 - std::floor(t / 1.5);
      put(hand, Vec3(0.04 * test::minimum_jerk(1.5 * s) * (1 - test::minimum_jerk(2 * s - 1)), 0.01, 0.002 * t),
          Quat(Eigen::AngleAxisd(0.3 * std::sin(t), Vec3::UnitX())));
      hand.button[0] = s > 0.31 && s < 0.71;
      hand.contact_force = std::max(0.0, 0.2 * std::sin(2 * t));
    };
    const MadeMotion::HandAt circling = [put](double t, HandReport& hand) {
      put(hand, Vec3(0.03 + 0.01 * std::cos(3 * t), 0.01 * std::sin(3 * t), 1e-4 * std::sin(16 * pi * t)),
          Quat(Eigen::AngleAxisd(0.5 * t, Vec3::UnitZ())));
      hand.contact_force = std::max(0.0, 0.1 * std::sin(3 * t));
    };
    m.before_step = [&m, swapped] {
      const double f = m.report.hands[swapped ? 1 : 0].contact_force;
      m.report.structures[0].of_hand = {Vec3::Zero(), Vec3::Zero()};
      m.report.structures[0].of_hand[swapped ? 1 : 0] = Vec3(0, f, 0);
    };
    if (swapped) m.show(12, circling, reaching);
    else m.show(12, reaching, circling);
  }
};

TEST(EveryMotionMetric, IsTheSameFromAnotherStartPose) {
  MadeMotion here(60), there(60);
  Work{}(here);
  Work{{Vec3(0.3, -2, 1), Quat(Eigen::AngleAxisd(1.1, Vec3(1, -2, 0.5).normalized()))}}(there);
  const auto a = here.values(), b = there.values();
  ASSERT_EQ(a.size(), b.size());
  EXPECT_GT(a.size(), 55u);
  for (const auto& [key, value] : a)
    EXPECT_NEAR(b.at(key), value, 1e-7 * std::max(1.0, std::abs(value))) << key.first << " " << key.second;
}

TEST(EveryMotionMetric, ChangesSidesWithTheHands) {
  MadeMotion one(60), other(60);
  Work{}(one);
  Work{}(other, true);
  const auto a = one.values(), b = other.values();
  ASSERT_EQ(a.size(), b.size());
  for (const auto& [key, value] : a) {
    const auto& [id, hand] = key;
    const double expected = id == "dominance" ? -value : value;
    EXPECT_NEAR(b.at({id, hand == 2 ? 2 : 1 - hand}), expected, 1e-12 * std::max(1.0, std::abs(value))) << id;
  }
}

TEST(EveryMotionMetric, IsNearlyTheSameAtAnotherFrameRate) {
  MadeMotion slow(120), fast(480);
  Work{}(slow);
  Work{}(fast);
  const auto a = slow.values(), b = fast.values();
  for (const auto& [key, value] : a) {
    const auto& [id, hand] = key;
    // The limits of speed and force are passed within a step, a few times.
    const double steps = id.ends_with("time") ? 4 / 120.0 : id == "coordination" ? 0.01 : 1e-4;
    if (!b.contains(key)) ADD_FAILURE() << id << " has a value at one rate alone";
    else EXPECT_NEAR(b.at(key), value, 0.03 * std::abs(value) + steps) << id << " " << hand;
  }
}

}  // namespace
}  // namespace insula
