// SPDX-License-Identifier: GPL-3.0-or-later
// The dose and the times against their closed forms, and every kind of channel.
#include <gtest/gtest.h>

#include <cmath>

#include "core/testing/example.h"

namespace insula {
namespace {

constexpr double unit = 1e-5 / 60;  // ml/100g/min

/// A circle without collaterals on the surface, and the right middle cerebral artery's territory.
std::unique_ptr<Simulation> scene(const std::string& circle, const std::string& attributes,
                                  const std::string& channel = "c.mca_superior_right.perfusion") {
  return test::load_text("<scene><circle_of_willis id=\"c\" " + circle + "/><ischaemia id=\"i\" channel=\"" + channel +
                             "\" " + attributes + "/></scene>",
                         "scene.xml");
}
const std::string none = R"(leptomeningeal="0" shut="m1_right")";

void run(Simulation& s, int steps, std::vector<Event>* events = nullptr) {
  for (int i = 0; i < steps; ++i) {
    s.step();
    for (const Event& e : s.events())
      if (events && e.id == "i") events->push_back(e);
  }
}

TEST(Ischaemia, TissueWithoutBloodDiesAtTheTimeOfArrest) {
  auto s = scene(none, R"(arrest="4 s")");
  ASSERT_TRUE(s);
  const double h = s->scene().time_step();
  std::vector<Event> events;
  const int n = 100;
  run(*s, n, &events);
  EXPECT_NEAR(s->channel("i.dose"), n * h / 4, 1e-12);
  EXPECT_NEAR(s->channel("i.time"), n * h, 1e-12);
  EXPECT_NEAR(s->channel("i.core_time"), n * h, 1e-12);
  EXPECT_NEAR(s->channel("i.left"), 4 - n * h, 1e-9);
  ASSERT_EQ(events.size(), 1u);
  EXPECT_EQ(events[0].kind, "ischaemia");
  run(*s, int(4 / h) + 2 - n, &events);
  EXPECT_EQ(s->channel("i.dose"), 1);
  ASSERT_EQ(events.size(), 2u);
  EXPECT_EQ(events[1].kind, "infarction");
  // It is dead, and blood does not help any more.
  ASSERT_EQ(s->command("ask", "c open m1_right"), "");
  run(*s, 300);
  EXPECT_EQ(s->channel("i.dose"), 1);
}

// T(f) = arrest + delay f / (infarct - f), with the values of Jones et al. 1981 that the manual names.
TEST(Ischaemia, ADoseAddsUpByTheLawOfItsPerfusion) {
  for (const char* collateral : {"0.1", "0.2", "0.3"}) {
    auto s = scene(std::string("shut=\"m1_right\" leptomeningeal=\"") + collateral + "\"", "");
    ASSERT_TRUE(s);
    const double h = s->scene().time_step(), f = s->channel("c.mca_superior_right.perfusion") / unit;
    ASSERT_LT(f, 17.5);
    ASSERT_GT(f, 1);
    run(*s, 50);
    const double lives = 300 + 82 * 60 * f / (17.5 - f);
    EXPECT_NEAR(s->channel("i.dose"), 50 * h / lives, 1e-12);
    EXPECT_NEAR(s->channel("i.core_time"), f < 10 ? 50 * h : 0, 1e-12);
  }
}

TEST(Ischaemia, ADoseDecaysWhenTheBloodIsBack) {
  auto s = scene(none, R"(arrest="4 s" recovery="3 s")");
  ASSERT_TRUE(s);
  const double h = s->scene().time_step();
  std::vector<Event> events;
  run(*s, 60, &events);
  ASSERT_EQ(s->command("ask", "c open m1_right"), "");
  run(*s, 1, &events);  // the open vessel is seen a step later
  const double dose = s->channel("i.dose");
  EXPECT_NEAR(dose, 61 * h / 4, 1e-12);
  run(*s, 90, &events);
  EXPECT_NEAR(s->channel("i.dose"), dose * std::exp(-90 * h / 3), 1e-12);
  EXPECT_NEAR(s->channel("i.time"), 61 * h, 1e-12);
  EXPECT_TRUE(std::isnan(s->channel("i.left")));
  ASSERT_EQ(events.size(), 2u);
  EXPECT_EQ(events[1].kind, "ischaemia_over");
  EXPECT_NEAR(events[1].value, 61 * h, 1e-12);
  s->reset();
  EXPECT_EQ(s->channel("i.dose"), 0);
}

TEST(Ischaemia, BetweenInfarctAndPenumbraTheDoseStands) {
  auto s = scene(none, R"(arrest="4 s" recovery="3 s")");
  auto half = scene(R"(leptomeningeal="0.5" shut="m1_right")", "");
  ASSERT_TRUE(s && half);
  run(*half, 20);
  const double f = half->channel("i.perfusion") / unit;
  ASSERT_GT(f, 17.5 - 3);
  ASSERT_LT(f, 20);
  auto between =
      scene(R"(leptomeningeal="0.5" shut="m1_right")", "infarct=\"" + std::to_string(f - 1) + " ml/100g/min\"");
  ASSERT_TRUE(between);
  run(*between, 20);
  EXPECT_EQ(between->channel("i.dose"), 0);
  EXPECT_NEAR(between->channel("i.time"), 20 * between->scene().time_step(), 1e-12);
}

TEST(Ischaemia, ReadsAFlowOfItsOwnRest) {
  auto s = scene("", R"(rest_flow="75.285 ml/min" rest_perfusion="60 ml/100g/min")", "c.mca_superior_right.outflow");
  ASSERT_TRUE(s);
  run(*s, 2);
  EXPECT_NEAR(s->channel("i.perfusion") / unit, 60, 1e-6);
}

std::string messages(const std::string& attributes) {
  return load_simulation_text("<scene><circle_of_willis id=\"c\"/><ischaemia " + attributes + "/></scene>", "scene.xml",
                              test::builtin())
      .diagnostics.format();
}

TEST(Ischaemia, SaysWhatIsWrong) {
  EXPECT_NE(messages(R"(channel="c.aca_left.perfusio")").find("did you mean \"c.aca_left.perfusion\""),
            std::string::npos);
  EXPECT_NE(messages(R"(channel="c.aca_left.outflow")").find("rest_flow"), std::string::npos);
  EXPECT_NE(messages(R"(channel="c.aca_left.perfusion" core="30 ml/100g/min")").find("penumbra"), std::string::npos);
}

}  // namespace
}  // namespace insula
