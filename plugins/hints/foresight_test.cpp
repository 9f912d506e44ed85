// SPDX-License-Identifier: GPL-3.0-or-later
// A value is carried on at its rate, as the filter's closed form says.
#include "plugins/hints/foresight.h"

#include <gtest/gtest.h>

namespace insula {
namespace {

TEST(Foresight, ARampIsCarriedOnByItsFilteredRate) {
  constexpr double h = 0.01, slope = 3, ahead = 0.2;
  Foresight foresight;
  EXPECT_EQ(foresight.carried_on(1, ahead, h), 1) << "nothing is known of its rate at first";
  for (int k = 1; k < 60; ++k) {
    const double value = 1 + slope * h * k;
    const double rate = slope * (1 - std::pow(Foresight::smoothing_s / (Foresight::smoothing_s + h), k));
    ASSERT_NEAR(foresight.carried_on(value, ahead, h), value + ahead * rate, 1e-12) << k;
  }
}

TEST(Foresight, AStillValueStaysAndAnUnknownOneForgetsTheRate) {
  Foresight foresight;
  for (int k = 0; k < 5; ++k) EXPECT_EQ(foresight.carried_on(2, 1, 0.01), 2);
  foresight.carried_on(3, 1, 0.01);
  EXPECT_TRUE(std::isnan(foresight.carried_on(std::nan(""), 1, 0.01)));
  EXPECT_EQ(foresight.carried_on(4, 1, 0.01), 4);
}

}  // namespace
}  // namespace insula
