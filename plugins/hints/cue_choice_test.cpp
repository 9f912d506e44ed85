// SPDX-License-Identifier: GPL-3.0-or-later
// Which hint speaks and when, with made shares in simulated time.
#include "plugins/hints/cue_choice.h"

#include <gtest/gtest.h>

namespace insula {
namespace {

constexpr double step = 0.1;

/// Times and hints of all cues. share(hint, time).
template <class Share>
std::vector<std::pair<double, int>> spoken(CueChoice& choice, std::vector<HintNow> hints, double until, Share share) {
  std::vector<std::pair<double, int>> out;
  for (int k = 1; k * step <= until + 1e-9; ++k) {
    for (std::size_t i = 0; i < hints.size(); ++i) hints[i].share = share(int(i), k * step);
    if (const int said = choice.choose(hints, k * step, step); said >= 0) out.emplace_back(k * step, said);
  }
  return out;
}

TEST(CueChoice, SpeaksInTheStepInWhichTheHintHolds) {
  CueChoice choice(1, 10);
  const auto said = spoken(choice, {{0, 0.7, 0}}, 5, [](int, double t) { return t > 1.95 ? 0.7 : 0.69; });
  ASSERT_EQ(said.size(), 1u);
  EXPECT_NEAR(said[0].first, 2.0, 1e-9);
}

TEST(CueChoice, WaitsForTheHold) {
  CueChoice choice(1, 10);
  const auto said = spoken(choice, {{0, 1, 0.5}}, 5, [](int, double t) { return t > 0.95 && !(t > 1.25 && t < 1.35); });
  ASSERT_EQ(said.size(), 1u);
  EXPECT_NEAR(said[0].first, 1.8, 1e-9) << "a gap begins the hold afresh";
}

TEST(CueChoice, TheWorstSpeaksAndTheOtherAfterThePause) {
  CueChoice choice(3, 10);
  const auto said =
      spoken(choice, {{0, 0.5, 0}, {0, 0.5, 0}, {0, 0.5, 0}}, 40, [](int i, double) { return i == 1 ? 1.4 : 0.8; });
  ASSERT_EQ(said.size(), 3u);
  EXPECT_EQ(said[0].second, 1);
  EXPECT_EQ(said[1].second, 0) << "of two that are equally bad the first one";
  EXPECT_EQ(said[2].second, 2);
  EXPECT_NEAR(said[1].first - said[0].first, 10, 1e-9);
  EXPECT_NEAR(said[2].first - said[1].first, 10, 1e-9);
}

TEST(CueChoice, AnUrgentOneSpeaksBeforeAWorseOneThatCanWait) {
  CueChoice choice(2, 10);
  std::vector<HintNow> hints{{0, 0.5, 0, false}, {0, 0.5, 0, true}};
  const auto said = spoken(choice, hints, 20, [](int i, double) { return i == 0 ? 3.0 : 0.8; });
  ASSERT_EQ(said.size(), 2u);
  EXPECT_EQ(said[0].second, 1);
  EXPECT_EQ(said[1].second, 0);
}

TEST(CueChoice, NeverTwoInThePauseHoweverManyHold) {
  CueChoice choice(5, 10);
  const auto said = spoken(choice, std::vector<HintNow>(5, {0, 0.5, 0}), 200,
                           [](int i, double t) { return std::fmod(t * (i + 3), 7) < 3 ? 0.2 : 1 + 0.1 * i; });
  ASSERT_GT(said.size(), 10u);
  for (std::size_t k = 1; k < said.size(); ++k) EXPECT_GE(said[k].first - said[k - 1].first, 10 - 1e-6);
}

TEST(CueChoice, SpeaksAgainOnlyAfterItCameBackByATenth) {
  CueChoice choice(1, 10);
  const auto share = [](int, double t) { return t < 20 ? 0.9 : t < 21 ? 0.75 : t < 40 ? 0.9 : t < 41 ? 0.71 : 0.9; };
  const auto said = spoken(choice, {{0, 0.8, 0}}, 60, share);
  ASSERT_EQ(said.size(), 2u) << "0.75 is not back by a tenth of 0.8, 0.71 is";
  EXPECT_NEAR(said[1].first, 41, 0.11);
}

TEST(CueChoice, AnUnknownShareIsNoCauseAndResetForgets) {
  CueChoice choice(1, 10);
  EXPECT_TRUE(spoken(choice, {{0, 0.5, 0}}, 20, [](int, double) { return std::nan(""); }).empty());
  EXPECT_EQ(spoken(choice, {{0, 0.5, 0}}, 1, [](int, double) { return 1.0; }).size(), 1u);
  choice.reset();
  EXPECT_EQ(spoken(choice, {{0, 0.5, 0}}, 1, [](int, double) { return 1.0; }).size(), 1u);
}

}  // namespace
}  // namespace insula
