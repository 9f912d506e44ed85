// SPDX-License-Identifier: GPL-3.0-or-later
// The soft force of a guide: its profile against the closed form, and its bounds, whatever the hand does.
#include "haptic_server/soft_guide.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <numbers>
#include <random>

#include "core/bus/plausible.h"

namespace insula {
namespace {

constexpr double tick_s = 1e-3;
constexpr double pi = std::numbers::pi;

GuideWish wish(std::int64_t number = 1, double force_N = 0.4, double duration_s = 1.2) {
  return {.session = 7,
          .number = number,
          .hand = 1,
          .direction = Vec3(0.6, 0, -0.8),
          .force_N = force_N,
          .duration_s = duration_s};
}

/// The closed form, piece by piece.
double closed_form(double t, double force, double duration) {
  if (t <= 0 || t >= duration) return 0;
  if (t < 0.3) return force * std::pow(std::sin(pi * t / 0.6), 2);
  if (t > duration - 0.3) return force * std::pow(std::sin(pi * (duration - t) / 0.6), 2);
  return force;
}

TEST(SoftGuide, FollowsItsClosedForm) {
  for (const double duration : {0.6, 1.2, 1.5}) {
    SoftGuide guide;
    guide.take(wish(1, 0.4, duration));
    const Vec3 still(0.01, 0.02, 0.03);
    for (int k = 1; k <= 2000; ++k) {
      const Vec3 force = guide.advance(tick_s, true, true, still);
      const double expected = closed_form(k * tick_s, 0.4, duration);
      ASSERT_NEAR((force - expected * Vec3(0.6, 0, -0.8)).norm(), 0, 1e-9) << k << " ms of " << duration << " s";
    }
    EXPECT_FALSE(guide.active());
  }
}

TEST(SoftGuide, FadesOutWhenItsMessagesStop) {
  for (const int stop : {100, 450, 1000}) {  // while it rises, holds and falls
    SoftGuide guide;
    guide.take(wish());
    for (int k = 1; k <= 1500; ++k) {
      const Vec3 force = guide.advance(tick_s, k <= stop, true, Vec3::Zero());
      const double silent = std::max(0, k - stop) * tick_s;
      const double fade = silent >= 0.3 ? 0 : std::pow(std::cos(pi * silent / 0.6), 2);
      ASSERT_NEAR(force.norm(), fade * closed_form(k * tick_s, 0.4, 1.2), 1e-9) << k << " ms";
    }
    EXPECT_FALSE(guide.active());
  }
}

TEST(SoftGuide, IsGoneAtOnceWithoutALiveForce) {
  SoftGuide guide;
  guide.take(wish());
  for (int k = 0; k < 500; ++k) guide.advance(tick_s, true, true, Vec3::Zero());
  EXPECT_TRUE(guide.active());
  EXPECT_TRUE(guide.advance(tick_s, true, false, Vec3::Zero()).isZero(0));
  EXPECT_TRUE(guide.advance(tick_s, true, true, Vec3::Zero()).isZero(0)) << "it does not come back";
}

TEST(SoftGuide, BeginsOnceANumberAndAtMostOnceInNineSeconds) {
  SoftGuide guide;
  int begun = 0;
  bool was = false;
  for (int k = 0; k < 60'000; ++k) {
    guide.take(wish(1 + k / 100));  // a new number ten times a second
    guide.advance(tick_s, true, true, Vec3::Zero());
    begun += guide.active() && !was;
    was = guide.active();
  }
  EXPECT_EQ(begun, 7) << "60 s";
  SoftGuide same;
  same.take(wish());
  for (int k = 0; k < 20'000; ++k) {
    same.take(wish());
    same.advance(tick_s, true, true, Vec3::Zero());
  }
  EXPECT_FALSE(same.active()) << "an old number";
}

TEST(SoftGuide, NothingOutOfRangeBeginsOne) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  std::vector<GuideWish> bad(8, wish());
  bad[0].force_N = 0.6;
  bad[1].force_N = nan;
  bad[2].force_N = -0.1;
  bad[3].duration_s = 1.6;
  bad[4].duration_s = nan;
  bad[5].direction = Vec3(nan, 0, 1);
  bad[6].direction = Vec3(1, 1, 1);
  bad[7].direction.setZero();
  for (const GuideWish& w : bad) {
    SoftGuide guide;
    guide.take(w);
    EXPECT_FALSE(guide.active());
    EXPECT_TRUE(guide.advance(tick_s, true, true, Vec3::Zero()).isZero(0));
  }
  SoftGuide guide;
  guide.take(wish());
  EXPECT_TRUE(guide.advance(0.3, true, true, Vec3(nan, 0, 0)).isZero(0)) << "a device without a place";
}

/// Work of the guide on a hand that moves as `place(k, force)` says; also its largest over any span.
template <class Place>
void expect_bounded_work(const char* what, Place place) {
  SoftGuide guide;
  guide.take(wish(1, limits::guide_N, limits::guide_s[1]));
  Vec3 force = Vec3::Zero(), last = place(0, force);
  double work = 0, least = 0, most = 0;
  for (int k = 1; k < 1600; ++k) {
    force = guide.advance(tick_s, true, true, last);
    const Vec3 now = place(k, force);
    work += force.dot(now - last);
    last = now;
    least = std::min(least, work);
    most = std::max(most, work - least);
    ASSERT_LE(force.norm(), limits::guide_N + 1e-12) << what;
  }
  EXPECT_LE(most, SoftGuide::energy_J * (1 + 1e-9)) << what;
}

TEST(SoftGuide, GivesAtMostFiveMillijoulesWhateverTheHandDoes) {
  const Vec3 along(0.6, 0, -0.8);
  for (const double speed : {0.01, 0.1, 1.0, 4.9})
    expect_bounded_work("pulled along", [&](int k, const Vec3&) { return Vec3(speed * k * tick_s * along); });
  std::mt19937 random(3);
  std::normal_distribution<double> step(0, 1e-3);
  Vec3 p = Vec3::Zero();
  expect_bounded_work("at random", [&](int, const Vec3&) {
    p += Vec3(step(random), step(random), step(random));
    return p;
  });
  // A hand that always goes where the force was larger, to and fro: it takes on the pulse, and gives back less.
  expect_bounded_work("to and fro", [&](int k, const Vec3&) { return Vec3(0.05 * std::sin(0.02 * k) * along); });
  // A free hand of 50 g with nothing that holds it.
  Vec3 v = Vec3::Zero(), x = Vec3::Zero();
  expect_bounded_work("free", [&](int, const Vec3& force) {
    v += tick_s * force / 0.05;
    x += tick_s * v;
    return x;
  });
  EXPECT_GT(0.5 * 0.05 * v.squaredNorm(), 0.5 * SoftGuide::energy_J) << "it does move a hand that lets it";
}

TEST(SoftGuide, ChangesSlowlyAgainstTheSlewLimitOfDevices) {
  SoftGuide guide;
  guide.take(wish(1, limits::guide_N, 0.6));
  Vec3 last = Vec3::Zero();
  for (int k = 0; k < 700; ++k) {
    const Vec3 force = guide.advance(tick_s, k < 250, true, Vec3::Zero());
    ASSERT_LT((force - last).norm() / tick_s, 6) << "N/s; a gate admits 66";
    last = force;
  }
}

}  // namespace
}  // namespace insula
