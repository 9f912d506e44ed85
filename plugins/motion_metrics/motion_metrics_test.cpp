// SPDX-License-Identifier: GPL-3.0-or-later
// Metrics of one hand against closed forms on made motions: a straight line, a circle, a sine, a minimum-jerk reach.
#include <numbers>

#include "core/testing/held.h"
#include "plugins/motion_metrics/made_motion_for_test.h"
#include "plugins/motion_metrics/speed_spectrum.h"

namespace insula {
namespace {

using test::at;
using test::held;
using test::MadeMotion;
constexpr double pi = std::numbers::pi;

/// A line along x at constant speed from one time to another.
MadeMotion::HandAt line(double speed, double from, double to) {
  return at([=](double t) { return Vec3(speed * (std::clamp(t, from, to) - from), 0, 0); });
}

MadeMotion::HandAt circle(double radius, double omega) {
  return [=](double t, HandReport& hand) {
    hand.device.p = hand.tip.p = radius * Vec3(std::cos(omega * t), std::sin(omega * t), 0);
    hand.device.q = hand.tip.q = Quat(Eigen::AngleAxisd(omega * t, Vec3::UnitZ()));
  };
}

TEST(HandMetrics, AStraightLineAtConstantSpeed) {
  const double rate = 100, v = 0.05;
  MadeMotion m(rate);
  m.show(4, nullptr, line(v, 1, 3));  // 200 steps
  EXPECT_TRUE(held("path", std::abs(m.value("path_length", 1) - 0.1), 0.1, 1e-12));
  EXPECT_TRUE(held("economy", std::abs(m.value("economy", 1) - 1), 1, 1e-12));
  EXPECT_EQ(m.value("movements", 1), 1);
  EXPECT_TRUE(held("mean speed", std::abs(m.value("speed_mean", 1) - v), v, 1e-10));
  EXPECT_TRUE(held("largest speed", std::abs(m.value("speed_peak", 1) - v), v, 1e-10));
  // The speed changes twice, each time within one step, among the 399 accelerations that are known.
  const double acceleration = std::sqrt(2 / 399.0) * v * rate;
  EXPECT_TRUE(held("acceleration", std::abs(m.value("acceleration", 1) - acceleration), acceleration, 1e-10));
  // Of the movement's 200 samples, two have a jerk of v / h^2: T^3 / v^2 * 2 h (v / h^2)^2 = 2 * 200^3.
  const double log_jerk = -std::log(2 * 200.0 * 200 * 200);
  EXPECT_TRUE(held("log dimensionless jerk", std::abs(m.value("log_dimensionless_jerk", 1) - log_jerk), 1, 1e-9));
  EXPECT_TRUE(held("time at work", std::abs(m.value("active_time", 1) - 2), 2, 1e-12));
  EXPECT_TRUE(held("idle time", std::abs(m.value("idle_time", 1) - 2.01), 2, 1e-12));
  EXPECT_EQ(m.value("turn", 1), 0);
  EXPECT_TRUE(std::isnan(m.value("path_length", 0))) << "a hand that was never there has no value";
}

/// Arc length of the amplitudes at the frequencies of the spectrum, by their closed form.
double arc_length(const std::function<double(double)>& amplitude) {
  int last = SpeedSpectrum::lines - 1;
  const auto of_line = [&](int k) { return amplitude(SpeedSpectrum::resolution_hz * k); };
  while (last > 1 && of_line(last) < SpeedSpectrum::least_amplitude) --last;
  double length = 0;
  for (int k = 1; k <= last; ++k) length += std::hypot(1.0 / last, of_line(k) - of_line(k - 1));
  return -length;
}

TEST(HandMetrics, SpectralArcLengthOfAConstantSpeedIsThatOfTheDirichletKernel) {
  const double rate = 60;
  for (const int n : {30, 60, 240}) {
    MadeMotion m(rate);
    m.show(1 + n / rate + 1, nullptr, line(0.05, 1, 1 + n / rate));
    const double exact = arc_length([&](double f) {
      const double half = pi * f / rate;
      return f == 0 ? 1 : std::abs(std::sin(n * half) / (n * std::sin(half)));
    });
    EXPECT_TRUE(held("spectral arc length", std::abs(m.value("spectral_arc_length", 1) - exact), 1, 1e-9)) << n;
  }
}

TEST(HandMetrics, ACircle) {
  const double rate = 60, r = 0.02, omega = 2 * pi;  // one turn a second
  MadeMotion m(rate);
  m.show(3, nullptr, circle(r, omega));
  const double half = std::sin(omega / rate / 2), speed = 2 * r * half * rate;
  EXPECT_TRUE(held("path", std::abs(m.value("path_length", 1) - 3 * speed), 3 * speed, 1e-12));
  EXPECT_TRUE(held("speed", std::abs(m.value("speed_peak", 1) - speed), speed, 1e-11));
  const double acceleration = r * std::pow(2 * half * rate, 2);
  EXPECT_TRUE(held("acceleration", std::abs(m.value("acceleration", 1) - acceleration), acceleration, 1e-10));
  EXPECT_NEAR(m.value("economy", 1), 0, 1e-9) << "full turns lead nowhere";
  EXPECT_TRUE(held("turn", std::abs(m.value("turn", 1) - 6 * pi), 6 * pi, 1e-9));
  EXPECT_NEAR(m.value("depth_travel", 1), 0, 1e-12) << "the shaft is normal to the circle";
}

TEST(HandMetrics, DepthIsThePathAlongTheShaft) {
  MadeMotion m(60);
  const Quat q = Quat::FromTwoVectors(Vec3::UnitZ(), Vec3(1, 2, 2).normalized());
  m.show(2, nullptr, [&](double t, HandReport& hand) {
    hand.tip = {0.01 * std::sin(pi * t) * Vec3(1, 2, 2) / 3 + 0.1 * t * Vec3(2, -1, 0), q};
    hand.device = hand.tip;
  });
  EXPECT_TRUE(held("depth", std::abs(m.value("depth_travel", 1) - 0.04), 0.04, 1e-12));  // up, down, down, up
}

/// Gain of the two Butterworth filters of second order after the bilinear transform.
double band_gain(double f, double from, double to, double rate) {
  const auto k = [&](double hz) { return std::tan(pi * hz / rate); };
  return 1 / std::sqrt((1 + std::pow(k(from) / k(f), 4)) * (1 + std::pow(k(f) / k(to), 4)));
}

TEST(HandMetrics, TremorOfASine) {
  for (const double rate : {60.0, 240.0})
    for (const double f : {1.0, 8.0, 10.0, 20.0}) {
      MadeMotion m(rate);
      const auto shake = at([&](double t) { return Vec3(1e-4 * std::sin(2 * pi * f * t) * Vec3(0.6, 0, 0.8)); });
      const double before = 30, after = 60;  // the transient is over, and full periods follow
      m.show(before, nullptr, shake);
      const double first = std::pow(m.value("tremor", 1), 2) * (before + m.report.h);
      for (int k = 1; k <= int(after * rate); ++k) m.step(before + k / rate, nullptr, shake);
      const double all = std::pow(m.value("tremor", 1), 2) * (before + after + m.report.h);
      const double exact = 1e-4 * std::sqrt(0.5) * band_gain(f, 8, 12, rate);
      EXPECT_TRUE(held("tremor", std::abs(std::sqrt((all - first) / after) - exact), exact, 1e-6)) << f << " " << rate;
    }
}

/// Times at which a reach is exactly at the limit of speed.
double time_at_limit(double length, double duration, double limit) {
  double low = 0, high = 0.5;
  for (int k = 0; k < 100; ++k) {
    const double mid = (low + high) / 2;
    (length / duration * test::minimum_jerk_speed(mid) < limit ? low : high) = mid;
  }
  return low * duration;
}

TEST(HandMetrics, SmoothnessOfAMinimumJerkReachConverges) {
  const double length = 0.1, duration = 1.6;
  // jerk = 60 L / T^3 (1 - 6 s + 6 s^2); the movement is the part that is faster than the limit.
  const double cut = time_at_limit(length, duration, 0.005) / duration;
  const auto primitive = [](double s) {  // of (1 - 6 s + 6 s^2)^2
    return s - 6 * s * s + 16 * s * s * s - 18 * std::pow(s, 4) + 7.2 * std::pow(s, 5);
  };
  const double jerk2 = 3600 * (primitive(1 - cut) - primitive(cut)), part = 1 - 2 * cut;
  const double log_jerk = -std::log(std::pow(part, 3) * jerk2 / (1.875 * 1.875));
  const double arc = arc_length([&](double f) {
    double re = 0, whole = 0;  // even about the middle
    const int n = 4000;
    for (int k = 0; k < n; ++k) {
      const double s = cut + part * (k + 0.5) / n;
      re += test::minimum_jerk_speed(s) * std::cos(2 * pi * f * duration * (s - 0.5));
      whole += test::minimum_jerk_speed(s);
    }
    return std::abs(re / whole);
  });
  for (const double rate : {60.0, 240.0, 960.0}) {
    MadeMotion m(rate);
    m.show(3, nullptr, at([&](double t) { return Vec3(0, length * test::minimum_jerk((t - 0.5) / duration), 0); }));
    EXPECT_TRUE(held("path", std::abs(m.value("path_length", 1) - length), length, 1e-12));
    EXPECT_TRUE(held("economy", std::abs(m.value("economy", 1) - 1), 1, 1e-12));
    EXPECT_EQ(m.value("movements", 1), 1);
    const double jerk_error = std::abs(m.value("log_dimensionless_jerk", 1) - log_jerk);
    const double arc_error = std::abs(m.value("spectral_arc_length", 1) - arc);
    EXPECT_LT(jerk_error, 8 / rate) << rate;
    EXPECT_LT(arc_error, 1 / rate) << rate;
  }
}

TEST(HandMetrics, ReachesWithAPauseAreTwoMovements) {
  MadeMotion m(120);
  m.show(4, nullptr,
         at([](double t) { return Vec3(0.05 * (test::minimum_jerk(t) - test::minimum_jerk(t - 2)), 0, 0); }));
  EXPECT_EQ(m.value("movements", 1), 2);
  EXPECT_NEAR(m.value("economy", 1), 1, 1e-12) << "each one is straight";
  MadeMotion one(120);
  one.show(3, nullptr,
           at([](double t) { return Vec3(0.05 * (test::minimum_jerk(t) - test::minimum_jerk(t - 1.0)), 0, 0); }));
  EXPECT_EQ(one.value("movements", 1), 1) << "the hand stands for less than the pause";
  EXPECT_NEAR(one.value("economy", 1), 0, 0.01);
}

TEST(HandMetrics, ForceOfAConstantAndOfASine) {
  const double rate = 60, offset = 0.2, swing = 0.1, f = 1;
  MadeMotion m(rate);
  m.show(10 - 1 / rate, nullptr,
         [&](double t, HandReport& hand) { hand.contact_force = offset + swing * std::sin(2 * pi * f * t); });
  EXPECT_TRUE(held("contact time", std::abs(m.value("contact_time", 1) - 10), 10, 1e-12));
  EXPECT_TRUE(held("mean", std::abs(m.value("force_mean", 1) - offset), offset, 1e-12));
  EXPECT_TRUE(held("impulse", std::abs(m.value("force_impulse", 1) - 10 * offset), 10 * offset, 1e-12));
  EXPECT_TRUE(held("peak", std::abs(m.value("force_peak", 1) - (offset + swing)), 1, 1e-12));
  const double rms = swing * 2 * std::sin(pi * f / rate) * rate * std::sqrt(0.5);
  EXPECT_TRUE(held("rate", std::abs(m.value("force_rate", 1) - rms), rms, 1e-2));  // 599 of 600 steps
  // A sine is below sin(x) for the share (x + pi/2) / pi of the time.
  const double p95 = offset + swing * std::sin(0.45 * pi);
  EXPECT_TRUE(held("95th percentile", std::abs(m.value("force_p95", 1) - p95), p95, 0.01));
}

TEST(HandMetrics, ForceIsOnTheTissueThatItActsOn) {
  MadeMotion m(100);
  ASSERT_EQ(m.report.structures.size(), 1u);
  m.before_step = [&] {
    m.report.structures[0].of_hand[0] = Vec3(0, 0, 0.3);
    m.report.structures[0].of_hand[1] = m.report.time < 0.995 ? Vec3(0, 0.06, 0.08) : Vec3::Zero();
  };
  const auto still = at([](double) { return Vec3(0, 0, 0); });
  m.show(2 - 0.01, still, still);
  EXPECT_NEAR(m.value("tissue_time.lower", 0), 2, 1e-12);
  EXPECT_NEAR(m.value("tissue_time.lower", 1), 1, 1e-12);
  EXPECT_NEAR(m.value("tissue_force_mean.lower", 0), 0.3, 1e-12);
  EXPECT_NEAR(m.value("tissue_force_peak.lower", 1), 0.1, 1e-12);
  EXPECT_NEAR(m.value("tissue_force_p95.lower", 0), 0.3, 0.002);
  EXPECT_NEAR(m.value("tissue_impulse.lower", 1), 0.1, 1e-12);
  // One drop of 0.1 N within 0.01 s among 100 changes while it touched.
  EXPECT_NEAR(m.value("tissue_force_rate.lower", 1), 10 * std::sqrt(1 / 100.0), 1e-9);
  EXPECT_NEAR(m.value("tissue_force_rate.lower", 0), 0, 1e-12);
}

TEST(HandMetrics, ButtonsAndExchanges) {
  MadeMotion m(10);
  const Instrument* other = m.simulation().instrument_of(0);
  m.show(9.9, nullptr, [&](double t, HandReport& hand) {
    hand.button = {t > 0.95 && t<2.95, t> 4.95 && t < 5.95};
    if (t > 7) hand.tool = other;
  });
  EXPECT_EQ(m.value("button_presses", 1), 2);
  EXPECT_NEAR(m.value("button_time", 1), 3, 1e-12);
  EXPECT_EQ(m.value("tool_exchanges", 1), 1);
  EXPECT_NEAR(m.value("active_time", 1), 3, 1e-12) << "who presses a button works";
  EXPECT_NEAR(m.value("idle_time", 1), 7, 1e-12);
}

TEST(HandMetrics, AHandThatIsGoneForAWhileLeavesNoPath) {
  MadeMotion m(50);
  const auto moves = at([](double t) { return Vec3(t < 1 ? 0.02 * t : 5 + 0.02 * t, 0, 0); });
  for (int k = 0; k < 50; ++k) m.step(k / 50.0, nullptr, moves);
  for (int k = 50; k < 60; ++k) m.step(k / 50.0, nullptr, nullptr);
  for (int k = 60; k < 110; ++k) m.step(k / 50.0, nullptr, moves);
  EXPECT_NEAR(m.value("path_length", 1), 2 * 49 * 0.02 / 50, 1e-12);
  EXPECT_NEAR(m.value("speed_peak", 1), 0.02, 1e-10);
}

TEST(HandMetrics, NothingCountsAfterTheEnd) {
  MadeMotion m(50);
  m.show(1, nullptr, line(0.05, 0, 100));
  const double path = m.value("path_length", 1);
  m.simulation().exercise()->log().fail("over", 1);
  for (int k = 51; k < 100; ++k) m.step(k / 50.0, nullptr, line(0.05, 0, 100));
  EXPECT_EQ(m.value("path_length", 1), path);
}

}  // namespace
}  // namespace insula
