// SPDX-License-Identifier: GPL-3.0-or-later
// The servo's figures of a second, and what is advised when they are bad.
#include "haptic_server/status.h"

#include <gtest/gtest.h>

#include <fstream>
#include <iterator>
#include <numeric>
#include <regex>
#include <string>

namespace insula {
namespace {

TEST(Status, CountsLatenessByItsBounds) {
  StatusCollector collector;
  for (const float late : {0.f, 10.f, 11.f, 20.f, 499.f, 500.f, 501.f, 20'000.f, 20'001.f, 1e9f})
    collector.add({.lateness_us = late});
  insula_lcm::haptic_status_t s{};
  collector.finish(1, s);
  const int wanted[12] = {2, 2, 0, 0, 0, 2, 1, 0, 0, 0, 1, 2};
  for (int k = 0; k < 12; ++k) EXPECT_EQ(s.lateness_count[k], wanted[k]) << k;
  EXPECT_EQ(std::accumulate(s.lateness_count, s.lateness_count + 12, 0), int(s.ticks_per_s));
  collector.finish(1, s);
  EXPECT_EQ(std::accumulate(s.lateness_count, s.lateness_count + 12, 0), 0);
}

TEST(Status, TheMessageTypeAndThePageHaveTheSameBounds) {
  std::string wanted;
  for (const float b : lateness_bounds_us) wanted += (wanted.empty() ? "" : ", ") + std::to_string(int(b));
  for (const char* file : {"lcm_types/haptic_status.lcm", "viewer/page/src/hud/haptic.ts"}) {
    std::ifstream in(std::string(INSULA_SOURCE_DIR "/") + file);
    std::string text((std::istreambuf_iterator<char>(in)), {});
    text = std::regex_replace(text, std::regex("\\s*\n\\s*// "), " ");
    EXPECT_NE(text.find(wanted), std::string::npos) << file << " should say " << wanted;
  }
}

TEST(Status, AdviceIsGivenWhenABudgetIsMissedAndOnlyThen) {
  insula_lcm::haptic_status_t good{};
  good.ticks_per_s = 1000;
  good.lateness_us_p99 = 60;
  good.solve_us_p99 = 200;
  good.realtime = 1;
  EXPECT_EQ(budget_advice(good, 1000, 2), "");
  auto s = good;
  s.solve_us_p99 = 900;
  s.rows = 180;
  EXPECT_EQ(budget_advice(s, 1000, 0),
            "solving takes 900 us of a tick's 1000: forces come late; less in contact at once (180 rows), or a faster "
            "processor");
  s = good;
  s.ticks_per_s = 900;
  EXPECT_EQ(budget_advice(s, 1000, 100),
            "10 % of the servo's ticks were missed: end what else runs on this machine, or try --spin 100");
  s.realtime = 0;
  EXPECT_NE(budget_advice(s, 1000, 100).find("allow real-time scheduling"), std::string::npos);
  s = good;
  s.lateness_us_p99 = 700;
  EXPECT_NE(budget_advice(s, 1000, 0).find("700 us late"), std::string::npos);
  s = good;
  s.residual_m_max = 5e-4;
  EXPECT_NE(budget_advice(s, 1000, 0).find("0.50 mm"), std::string::npos);
}

}  // namespace
}  // namespace insula
