// SPDX-License-Identifier: GPL-3.0-or-later
// A slower machine makes smaller steps.
#include "haptic_server/newton_budget.h"

#include <gtest/gtest.h>

namespace insula {
namespace {

TEST(NewtonBudget, EightTimesTheTimeHalvesTheUnknowns) {
  EXPECT_EQ(unknowns_within(0.4e-3, 200, 0.3e-3), 200);
  EXPECT_EQ(unknowns_within(0.4e-3, 200, 3.2e-3), 100);
  EXPECT_EQ(unknowns_within(0, 200, 1e-3), 0);
}

TEST(NewtonBudget, TheTimeOfThisMachineGrowsWithTheUnknowns) {
  const double small = factorisation_time(40), large = factorisation_time(200);
  EXPECT_GT(small, 0);
  EXPECT_GT(large, 5 * small);
  EXPECT_LT(large, 0.1);
}

}  // namespace
}  // namespace insula
