// SPDX-License-Identifier: GPL-3.0-or-later
// Reference bands against closed forms.
#include "engine/session/bands.h"

#include <gtest/gtest.h>

#include <cmath>

namespace insula {
namespace {

std::vector<BandSession> sessions(const std::map<std::string, std::vector<double>>& groups) {
  std::vector<BandSession> out;
  for (const auto& [group, values] : groups)
    for (const double v : values) out.push_back({group, "", {{{"path_length", "right"}, {"mm", "low", v}}}});
  return out;
}

MetricBand only(const std::vector<BandSession>& all, const PassMark& pass = {}) {
  const auto found = bands(all, pass);
  EXPECT_EQ(found.size(), 1u);
  return found.at(0);
}

TEST(Quantile, InterpolatesBetweenTheOrderStatistics) {
  const std::vector<double> v{1, 2, 4, 8};
  EXPECT_EQ(quantile(v, 0), 1);
  EXPECT_EQ(quantile(v, 1), 8);
  EXPECT_EQ(quantile(v, 0.5), 3);
  EXPECT_NEAR(quantile(v, 0.9), 4 + 0.7 * 4, 1e-12);
  EXPECT_EQ(quantile({5}, 0.3), 5);
}

TEST(Bands, OfAGroup) {
  const MetricBand m = only(sessions({{"a", {4, 1, 3, 2, 5}}}));
  ASSERT_EQ(m.groups.size(), 1u);
  const GroupBand& g = m.groups[0];
  EXPECT_EQ(g.sessions, 5u);
  EXPECT_EQ(g.mean, 3);
  EXPECT_NEAR(g.deviation, std::sqrt(2.5), 1e-12);
  EXPECT_EQ(g.median, 3);
  EXPECT_EQ(g.quantiles.at(0.25), 2);
  EXPECT_LE(g.median_low, 2);
  EXPECT_GE(g.median_high, 4);
  EXPECT_TRUE(std::isnan(m.effect)) << "one group has no effect";
  EXPECT_TRUE(std::isnan(m.pass_mark));
}

// The bootstrap of the median of n values has an exact distribution: the resampled median of three values is the
// middle one with probability 13/27 and each other one with 7/27.
TEST(Bands, TheIntervalOfTheMedianIsThatOfTheBootstrap) {
  const GroupBand g = only(sessions({{"a", {1, 2, 3}}})).groups[0];
  EXPECT_EQ(g.median_low, 1);
  EXPECT_EQ(g.median_high, 3);
  std::vector<double> many;
  for (int k = 0; k < 401; ++k) many.push_back(k);
  // Normal approximation: 200 +- 1.96 * 0.5 * sqrt(401).
  const GroupBand wide = only(sessions({{"a", many}})).groups[0];
  EXPECT_NEAR(wide.median_low, 200 - 1.96 * 0.5 * std::sqrt(401.0), 3);
  EXPECT_NEAR(wide.median_high, 200 + 1.96 * 0.5 * std::sqrt(401.0), 3);
}

TEST(Bands, EffectOfTwoGroupsIsHedgesG) {
  const MetricBand m = only(sessions({{"a", {1, 2, 3}}, {"b", {4, 5, 6}}}));
  // Difference 3, pooled deviation 1, correction 1 - 3 / (4 * 4 - 1).
  EXPECT_NEAR(m.effect, 3 * (1 - 3.0 / 15), 1e-12);
  EXPECT_EQ(m.leave_one_out, 1);
  EXPECT_EQ(m.chance, 0.5);
}

TEST(Bands, EffectOfThreeGroupsIsEtaSquared) {
  const MetricBand m = only(sessions({{"a", {0, 2}}, {"b", {4, 6}}, {"c", {8, 10}}}));
  EXPECT_NEAR(m.effect, 64.0 / 70, 1e-12);
  EXPECT_EQ(m.leave_one_out, 1) << "two apart, and four between groups";
}

TEST(Bands, LeaveOneOutDoesNotKnowTheSessionItself) {
  // 5 is nearer to b's mean than to that of the rest of a.
  const MetricBand m = only(sessions({{"a", {1, 1, 5}}, {"b", {6, 6, 6}}}));
  EXPECT_NEAR(m.leave_one_out, 5.0 / 6, 1e-12);
}

TEST(Bands, ThePassMarkIsOfTheNamedGroup) {
  const auto all = sessions({{"experts", {1, 2, 3, 6}}, {"novices", {10, 12}}});
  EXPECT_EQ(only(all, {"experts"}).pass_mark, 3);
  EXPECT_EQ(only(all, {"experts", 0.5}).pass_mark, 2.5);
  EXPECT_TRUE(std::isnan(only(all, {"nobody"}).pass_mark));
}

TEST(Bands, FewPersonsAreSaid) {
  std::vector<BandSession> all = sessions({{"a", std::vector<double>(12, 1)}, {"b", std::vector<double>(12, 1)}});
  EXPECT_TRUE(band_warnings(all).empty());
  for (BandSession& s : all)
    if (s.group == "b") s.person = "P1";
  ASSERT_EQ(band_warnings(all).size(), 1u);
  EXPECT_EQ(band_warnings(all)[0], "group \"b\" has 1 persons; bands of fewer than 10 say little");
}

}  // namespace
}  // namespace insula
