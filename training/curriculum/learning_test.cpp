// SPDX-License-Identifier: GPL-3.0-or-later
// The statistics of learning against closed forms.
#include "training/curriculum/learning.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <numeric>
#include <stdexcept>

namespace insula {
namespace {

TEST(Cusum, LimitsFollowTheirFormula) {
  // p1 = 2 p0 with p0 = 1/4: P = ln 2, Q = ln(3/2), P + Q = ln 3.
  const CusumLimits l = cusum_limits({0.25, 0.5, 0.1, 0.1});
  EXPECT_NEAR(l.s, std::log(1.5) / std::log(3.0), 1e-15);
  EXPECT_NEAR(l.h0, 2, 1e-14) << "ln 9 / ln 3";
  EXPECT_NEAR(l.h1, 2, 1e-14);
  const CusumLimits uneven = cusum_limits({0.25, 0.5, 0.1, 0.2});
  EXPECT_NEAR(uneven.h0, std::log(0.9 / 0.2) / std::log(3.0), 1e-14);
  EXPECT_NEAR(uneven.h1, std::log(0.8 / 0.1) / std::log(3.0), 1e-14);
}

TEST(Cusum, TheStepLiesBetweenTheRates) {
  for (const double p0 : {0.01, 0.05, 0.1, 0.2})
    for (const double p1 : {0.21, 0.3, 0.5}) {
      const double s = cusum_limits({p0, p1, 0.1, 0.1}).s;
      EXPECT_GT(s, p0);
      EXPECT_LT(s, p1);
    }
}

TEST(Cusum, AScoreIsTheLogOfTheLikelihoodRatio) {
  const CusumDesign d{0.05, 0.15, 0.05, 0.1};
  const CusumLimits l = cusum_limits(d);
  const double unit = std::log(d.unacceptable / d.acceptable) + std::log((1 - d.acceptable) / (1 - d.unacceptable));
  EXPECT_NEAR((1 - l.s) * unit, std::log(d.unacceptable / d.acceptable), 1e-14) << "of a failure";
  EXPECT_NEAR(-l.s * unit, std::log((1 - d.unacceptable) / (1 - d.acceptable)), 1e-14) << "of a success";
}

TEST(Cusum, SuccessesAreAcceptedAndFailuresAlarm) {
  const CusumLimits l = cusum_limits({0.05, 0.15, 0.1, 0.1});
  const Cusum good = cusum(std::vector<bool>(100, false), l);
  ASSERT_TRUE(good.accepted);
  EXPECT_EQ(*good.accepted + 1, std::size_t(std::ceil(l.h0 / l.s)));
  EXPECT_FALSE(good.alarmed);
  const Cusum bad = cusum(std::vector<bool>(100, true), l);
  EXPECT_EQ(*bad.alarmed + 1, std::size_t(std::ceil(l.h1 / (1 - l.s))));
  EXPECT_FALSE(bad.accepted);
  const Cusum mixed = cusum({false, true, false}, l);
  EXPECT_NEAR(mixed.sum.at(2), 1 - 3 * l.s, 1e-15);
  EXPECT_FALSE(mixed.accepted || mixed.alarmed);
  EXPECT_TRUE(cusum({}, l).sum.empty());
}

TEST(Cusum, ImpossibleDesignsAreRefused) {
  for (const CusumDesign& d :
       {CusumDesign{0, 0.1, 0.1, 0.1}, CusumDesign{0.1, 0.1, 0.1, 0.1}, CusumDesign{0.2, 1, 0.1, 0.1},
        CusumDesign{0.1, 0.2, 0, 0.1}, CusumDesign{0.1, 0.2, 0.5, 0.5}, CusumDesign{std::nan(""), 0.2, 0.1, 0.1}})
    EXPECT_THROW(cusum_limits(d), std::invalid_argument);
}

TEST(AttemptsToLevel, CountsToTheEndOfTheRow) {
  EXPECT_EQ(attempts_to_level({true, false, true, true}, 2), 4);
  EXPECT_EQ(attempts_to_level({true, false, true, true}, 1), 1);
  EXPECT_EQ(attempts_to_level({true, false, true}, 2), std::nullopt);
  EXPECT_EQ(attempts_to_level({}, 1), std::nullopt);
  EXPECT_EQ(attempts_to_level({true}, 0), std::nullopt);
}

TEST(MovingMedian, OfOddEvenAndUnknownValues) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  EXPECT_EQ(moving_median(std::vector<double>{5, 1, 3, 9, 2}, 3), (std::vector<double>{5, 3, 3, 3, 3}));
  const std::vector<double> values{nan, 4, nan, nan, nan};
  const auto medians = moving_median(values, 2);
  EXPECT_TRUE(std::isnan(medians[0]));
  EXPECT_EQ(medians[1], 4);
  EXPECT_EQ(medians[2], 4);
  EXPECT_TRUE(std::isnan(medians[3]));
  std::vector<double> row(100);
  std::iota(row.begin(), row.end(), 0.0);
  EXPECT_EQ(moving_median(row, 1), row);
  EXPECT_EQ(moving_median(row, 21).back(), 89) << "the middle of 79 to 99";
  EXPECT_THROW(moving_median(row, 0), std::invalid_argument);
  EXPECT_TRUE(moving_median({}, 5).empty());
}

}  // namespace
}  // namespace insula
