// SPDX-License-Identifier: GPL-3.0-or-later
// The pressure of the arteries in a pause of the heart against the exponentials, step by step; doses and refusals.
#include <gtest/gtest.h>

#include <cmath>

#include "core/registry/surgeon_requests.h"
#include "plugins/pressure/pressure.h"
#include "plugins/pressure/shell_for_test.h"
#include "plugins/pressure/waveform.h"

namespace insula {
namespace {

using test::mmHg;

// 35 mg for 70 kg are 0.5 mg/kg: with 8 s for each mg/kg the heart pauses for 4 s, from 0.5 s on.
struct Artery : test::TestScene {
  static constexpr double h = 0.01;
  explicit Artery(const std::string& pressure, const std::string& doses = R"(weight="70 kg" most="60 mg")") {
    folder.write("meshes/ball.obj", test::obj_text(test::ball(Vec3(0.04, -0.01, 0.02), 0.004, 2)));
    load(fmt::format(R"(<scene time_step="10 ms">
  <adenosine_pause id="a" pressure="p" {} delay="500 ms" pause_per_dose="8 s" floor="15 mmHg"
                   fall="1.6 s" rise="0.5 s"/>
  <shell_body id="artery" mesh="meshes/ball.obj" mesh_unit="m"><test_wall stiffness="50 N/m"/></shell_body>
  <pressure id="p" on="artery" {}/></scene>)",
                     doses, pressure));
  }
  double channel(const char* name) const {
    const ChannelEntry* e = s->channels().find(name);
    return e ? e->channel->values(e->item)[0] : std::nan("");
  }
  std::string give(const char* dose) const { return s->scene().find("a")->run_command("give_adenosine", dose); }
};

TEST(AdenosinePause, FallsAndRecoversAsTheExponentialsSay) {
  const Artery f(R"(systolic="100 mmHg" diastolic="100 mmHg")");
  ASSERT_TRUE(f.s) << f.messages;
  f.run(10);
  ASSERT_EQ(f.give("35"), "");
  f.run(50);
  EXPECT_NEAR(f.channel("p.arterial"), 100 * mmHg, 1e-9) << "the dose is on its way";
  for (int i = 1; i <= 400; ++i) {
    f.run(1);
    const double expected = 15 + 85 * std::exp(-i * f.h / 1.6);
    if (i < 400) {
      EXPECT_NEAR(f.channel("p.arterial") / mmHg, expected, 1e-9);
      EXPECT_NEAR(f.channel("a.remaining"), 4 - i * f.h, 1e-9);
      EXPECT_NEAR(f.get<BloodPressure>("p").pressure(0) / mmHg, expected, 1e-9) << "the wall bears it in the same step";
    }
  }
  const double missing = std::exp(-4 / 1.6);
  for (int i = 0; i < 499; ++i) {
    EXPECT_NEAR(f.channel("p.arterial") / mmHg, 15 + 85 * (1 - (1 - missing) * std::exp(-i * f.h / 0.5)), 1e-9);
    EXPECT_EQ(f.channel("a.remaining"), 0);
    f.run(1);
  }
  f.run(2);
  EXPECT_NEAR(f.channel("p.arterial"), 100 * mmHg, 1e-9);
}

TEST(AdenosinePause, StopsTheBeatWhereItIsAndGoesOnThere) {
  const Artery f(R"(systolic="120 mmHg" diastolic="80 mmHg" heart_rate="72 1/min")");
  ASSERT_TRUE(f.s) << f.messages;
  ASSERT_EQ(f.give("35"), "");
  f.run(50);
  const PulseWave wave;
  const auto beat = [&](int steps) { return 80 + 40 * wave.value(steps * f.h * 1.2); };
  for (int i = 0; i < 400; ++i) {
    EXPECT_NEAR(f.channel("p.heart_phase"), 0.6, 1e-9);
    EXPECT_NEAR(f.channel("p.arterial") / mmHg, 15 + (beat(50) - 15) * std::exp(-i * f.h / 1.6), 1e-9);
    f.run(1);
  }
  const double missing = 1 - std::exp(-4 / 1.6);
  for (int i = 0; i < 499; ++i) {
    EXPECT_NEAR(f.channel("p.arterial") / mmHg, 15 + (beat(50 + i) - 15) * (1 - missing * std::exp(-i * f.h / 0.5)),
                1e-9);
    f.run(1);
  }
}

TEST(AdenosinePause, RefusesWhatWouldBeTooMuch) {
  const Artery f(R"(systolic="100 mmHg" diastolic="100 mmHg")");
  ASSERT_TRUE(f.s) << f.messages;
  EXPECT_EQ(f.give("61"), "give_adenosine: 61 is outside the allowed range 1 to 60");
  EXPECT_NE(f.give("much"), "");
  EXPECT_EQ(f.give("35"), "");
  EXPECT_EQ(f.give("5"), "the last dose of adenosine still acts");
  f.run(1000);
  EXPECT_EQ(f.give("26"), "no more adenosine: the total would be too high");
  EXPECT_EQ(f.give("25"), "");
  f.run(1);
  EXPECT_EQ(f.channel("a.doses"), 2);
  EXPECT_NEAR(f.channel("a.total"), 60e-6, 1e-15);
  f.s->reset();
  f.run(1);
  EXPECT_EQ(f.channel("a.doses"), 0);
  EXPECT_NEAR(f.channel("p.arterial"), 100 * mmHg, 1e-9);
}

TEST(AdenosinePause, TheSurgeonAsksForTheUsualDose) {
  const auto usual = [](const std::string& doses) {
    const Artery f(R"(systolic="100 mmHg" diastolic="100 mmHg")", doses);
    const auto* takes = f.s ? dynamic_cast<const TakesSurgeonRequests*>(f.s->scene().find("a")) : nullptr;
    return takes ? takes->surgeon_requests().at(0).usual : std::nan("");
  };
  EXPECT_EQ(usual(R"(weight="70 kg")"), 25) << "0.35 mg/kg in whole milligrams";
  EXPECT_EQ(usual(R"(weight="20 kg")"), 7);
  EXPECT_EQ(usual(R"(weight="250 kg" most="60 mg")"), 60) << "no more than is given at all";
}

TEST(AdenosinePause, BelongsToOneHeartAlone) {
  test::SceneFolder folder;
  folder.write("meshes/ball.obj", test::obj_text(test::ball(Vec3(0.04, -0.01, 0.02), 0.004, 2)));
  const auto r = load_simulation_text(R"(<scene>
  <shell_body id="artery" mesh="meshes/ball.obj" mesh_unit="m"><test_wall/></shell_body>
  <pressure id="p" on="artery"/>
  <adenosine_pause id="a" pressure="p"/><adenosine_pause id="b" pressure="p"/></scene>)",
                                      folder.path() / "scene.xml", test::with_test_wall(), 1);
  EXPECT_FALSE(r.simulation);
  EXPECT_NE(r.diagnostics.format().find("has a pause already"), std::string::npos) << r.diagnostics.format();
}

}  // namespace
}  // namespace insula
