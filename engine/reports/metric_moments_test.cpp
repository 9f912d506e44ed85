// SPDX-License-Identifier: GPL-3.0-or-later
// The moment at which a metric became worse by most.
#include "engine/reports/metric_moments.h"

#include <gtest/gtest.h>

namespace insula {
namespace {

MetricValue metric(const std::string& id, double value, Better better, bool known = true) {
  return {id, "Text", "Insula", right_hand, known, value, "mm", 0, better};
}

TEST(MetricMoments, IsTheSecondOfTheLargestChangeToTheWorse) {
  MetricMoments moments;
  const double path[] = {1, 2, 7, 8, 20, 21}, economy[] = {0.9, 0.8, 0.85, 0.3, 0.2, 0.6};
  for (int k = 0; k < 6; ++k)
    moments.observe(k + 1.0, {metric("path", path[k], Better::low), metric("economy", economy[k], Better::high),
                              metric("time", k, Better::none)});
  EXPECT_EQ(moments.worst_s(metric("path", 0, Better::low)), 5.0);
  EXPECT_EQ(moments.worst_s(metric("economy", 0, Better::high)), 4.0);
  EXPECT_EQ(moments.worst_s(metric("time", 0, Better::none)), std::nullopt);
  EXPECT_EQ(moments.worst_s(metric("other", 0, Better::low)), std::nullopt);
}

TEST(MetricMoments, WhatIsNotKnownOrNeverWorseHasNone) {
  MetricMoments moments;
  moments.observe(1, {metric("a", 5, Better::low, false), metric("b", 1, Better::high)});
  moments.observe(2, {metric("a", 5, Better::low, false), metric("b", 2, Better::high)});
  EXPECT_EQ(moments.worst_s(metric("a", 0, Better::low)), std::nullopt);
  EXPECT_EQ(moments.worst_s(metric("b", 0, Better::high)), std::nullopt);
}

}  // namespace
}  // namespace insula
