// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/bus/arrival_order.h"

#include <gtest/gtest.h>

namespace insula {
namespace {

constexpr std::int64_t ms = 1'000'000;

TEST(ArrivalOrder, TakesEachNumberOnceAndOnlyForwards) {
  ArrivalOrder order;
  EXPECT_TRUE(order.take(7, 10, 1 * ms));
  EXPECT_FALSE(order.take(7, 10, 2 * ms));
  EXPECT_FALSE(order.take(7, 9, 2 * ms));
  EXPECT_TRUE(order.take(7, 12, 3 * ms));
  EXPECT_FALSE(order.take(7, 11, 3 * ms));
}

TEST(ArrivalOrder, ALaterSenderIsBelievedWhenItGoesOnAndTheEarlierNoMore) {
  ArrivalOrder order;
  EXPECT_TRUE(order.take(7, 10, 1 * ms));
  EXPECT_FALSE(order.take(8, 1, 2 * ms));
  EXPECT_TRUE(order.take(7, 11, 3 * ms));
  EXPECT_TRUE(order.take(8, 2, 4 * ms));
  EXPECT_FALSE(order.take(7, 12, 5 * ms));
  EXPECT_TRUE(order.take(7, 13, 4 * ms + ArrivalOrder::silence_ns + 1));
}

TEST(ArrivalOrder, OneNumberFarAheadShutsNobodyOut) {
  ArrivalOrder order;
  EXPECT_TRUE(order.take(7, 10, 1 * ms));
  EXPECT_FALSE(order.take(7, 1'000'000, 2 * ms));
  EXPECT_FALSE(order.take(1'000'000'000, 11, 2 * ms));
  EXPECT_TRUE(order.take(7, 11, 3 * ms));
  EXPECT_FALSE(order.take(7, 2'000'000, 4 * ms));
  EXPECT_TRUE(order.take(7, 2'000'001, 5 * ms));  // it means it
}

TEST(ArrivalOrder, AClockThatGoesBackShutsNobodyOut) {
  ArrivalOrder order;
  EXPECT_TRUE(order.take(7, 10, 10'000 * ms));
  EXPECT_TRUE(order.take(7, 3, 1 * ms));
}

}  // namespace
}  // namespace insula
