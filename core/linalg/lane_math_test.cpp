// SPDX-License-Identifier: GPL-3.0-or-later
// Functions of lanes against those of the standard library.
#include "core/linalg/lane_math.h"

#include <gtest/gtest.h>

#include <numbers>
#include <random>

namespace insula {
namespace {

using Two = double __attribute__((vector_size(16)));

TEST(LaneMath, DirectionIsTheArcTangentInEveryQuadrant) {
  std::mt19937 dice(3);
  std::uniform_real_distribution<double> any(-1, 1), exponent(-12, 3);
  for (int k = 0; k < 200000; ++k) {
    const double y = any(dice) * std::pow(10, exponent(dice)), x = any(dice) * std::pow(10, exponent(dice));
    const double expected = std::atan2(y, x);
    // To rounding of the angle from the nearest axis: what is small keeps its digits.
    ASSERT_NEAR(direction(y, x), expected, 4e-16 * (x > 0 ? std::max(std::abs(expected), 1e-300) : 3))
        << y << ", " << x;
    const Two both = direction(Two{y, -x}, Two{x, y});
    ASSERT_EQ(both[0], direction(y, x));
    ASSERT_EQ(both[1], direction(-x, y));
  }
  for (const double axis : {0.0, 1e-300, 1.0, 1e300}) {
    EXPECT_EQ(direction(0.0, axis), 0);
    if (axis == 0) continue;
    EXPECT_EQ(direction(axis, 0.0), std::numbers::pi / 2);
    EXPECT_EQ(direction(-axis, 0.0), -std::numbers::pi / 2);
    EXPECT_EQ(direction(0.0, -axis), std::numbers::pi);
    EXPECT_NEAR(direction(axis, axis), std::numbers::pi / 4, 2e-16);
  }
}

TEST(LaneMath, WholeNumbersAndRoots) {
  for (const double x : {0.0, 0.49, 0.51, -0.49, -0.51, 3.2, -7.8, 1e9 + 0.7})
    EXPECT_EQ(whole(x), std::nearbyint(x)) << x;
  const Two r = root(Two{2, 9});
  EXPECT_EQ(r[0], std::sqrt(2.0));
  EXPECT_EQ(r[1], 3);
}

}  // namespace
}  // namespace insula
