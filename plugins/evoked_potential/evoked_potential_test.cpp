// SPDX-License-Identifier: GPL-3.0-or-later
// The amplitude against the exact solution of its law, its alarm, its latency and its trace.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "core/testing/example.h"

namespace insula {
namespace {

constexpr double unit = 1e-5 / 60;  // ml/100g/min

std::unique_ptr<Simulation> scene(const std::string& circle, const std::string& attributes) {
  return test::load_text("<scene><circle_of_willis id=\"c\" " + circle +
                             "/><evoked_potential id=\"e\" channel=\"c.mca_superior_right.perfusion\" " + attributes +
                             "/></scene>",
                         "scene.xml");
}
const std::string none = R"(leptomeningeal="0" shut="m1_right")";

TEST(EvokedPotential, FallsAndComesBackByItsLaw) {
  auto s = scene(none, R"(decline="2 s" return="5 s")");
  ASSERT_TRUE(s);
  const double h = s->scene().time_step();
  std::vector<Event> events;
  const auto run = [&](int steps) {
    for (int i = 0; i < steps; ++i) {
      s->step();
      for (const Event& e : s->events())
        if (e.id == "e") events.push_back(e);
    }
  };
  run(60);
  EXPECT_NEAR(s->channel("e.amplitude"), std::exp(-60 * h / 2), 1e-12);
  EXPECT_TRUE(events.empty());
  run(60);
  const double low = std::exp(-120 * h / 2);
  EXPECT_NEAR(s->channel("e.amplitude"), low, 1e-12);
  EXPECT_NEAR(s->channel("e.latency"), 0.02 * (1 + 0.2 * (1 - low)), 1e-12);
  ASSERT_EQ(events.size(), 1u);
  EXPECT_EQ(events[0].kind, "evoked_potential_low");
  EXPECT_NEAR(events[0].value, 0.5, 0.5 * h / 2 + 1e-9);
  EXPECT_NEAR(events[0].time, 2 * std::log(2.0), h + 1e-9);
  ASSERT_EQ(s->command("ask", "c open m1_right"), "");
  run(1);  // the open vessel is seen a step later
  const double start = s->channel("e.amplitude");
  run(120);
  EXPECT_NEAR(s->channel("e.amplitude"), 1 - (1 - start) * std::exp(-120 * h / 5), 1e-12);
  ASSERT_EQ(events.size(), 2u);
  EXPECT_EQ(events[1].kind, "evoked_potential_back");
  EXPECT_GE(events[1].value, 0.55);
}

TEST(EvokedPotential, SettlesAtTheAmplitudeOfItsPerfusion) {
  auto s = scene(R"(leptomeningeal="0.5" shut="m1_right")",
                 R"(decline="0.1 s" lost="12 ml/100g/min" full="22 ml/100g/min")");
  ASSERT_TRUE(s);
  for (int i = 0; i < 300; ++i) s->step();
  const double f = s->channel("c.mca_superior_right.perfusion") / unit;
  ASSERT_GT(f, 12);
  ASSERT_LT(f, 22);
  EXPECT_NEAR(s->channel("e.amplitude"), (f - 12) / 10, 1e-9);
}

TEST(EvokedPotential, ItsTraceShowsTheWaveAtItsLatency) {
  auto s = scene("", R"(sweep="2 s" window="50 ms")");
  ASSERT_TRUE(s);
  const double h = s->scene().time_step();
  double peak = -1, at = 0, least = 1;
  for (int i = 1; i <= int(2 / h); ++i) {
    s->step();
    const double v = s->channel("e.trace");
    if (v > peak) peak = v, at = i * h;
    least = std::min(least, v);
  }
  EXPECT_NEAR(peak, 1, 0.02);
  EXPECT_NEAR(at * 50e-3 / 2, 20e-3, 50e-3 * h / 2 + 1e-9);
  EXPECT_LT(least, -0.6);
}

TEST(EvokedPotential, AFlatOneHasNoLatency) {
  auto s = scene(none, R"(decline="0.1 s")");
  ASSERT_TRUE(s);
  for (int i = 0; i < 100; ++i) s->step();
  EXPECT_LT(s->channel("e.amplitude"), 1e-6);
  EXPECT_TRUE(std::isnan(s->channel("e.latency")));
}

}  // namespace
}  // namespace insula
