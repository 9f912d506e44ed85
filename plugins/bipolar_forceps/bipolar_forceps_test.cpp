// SPDX-License-Identifier: GPL-3.0-or-later
// The heat of the tissue between the tips against closed forms, and what it closes, burns and leaves open.
#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <numbers>
#include <sstream>

#include "core/sim/simulation.h"
#include "core/testing/example.h"
#include "core/testing/held.h"
#include "core/testing/held_tool.h"
#include "plugins/bipolar_forceps/heated_tissue.h"
#include "plugins/bridging_veins/bridging_veins.h"

namespace insula {
namespace {

constexpr double volume = 3e-9, power = 0.8, step = 0.0166667;

TEST(HeatedTissue, ItsConstantsAreThoseOfASphere) {
  const HeatedTissue t(volume);
  const double r = std::cbrt(volume * 3 / (4 * std::numbers::pi));
  EXPECT_NEAR(t.capacity(), 3.7e6 * volume, 1e-18);
  EXPECT_NEAR(t.conductance(), 4 * std::numbers::pi * 0.5 * r, 1e-15);
}

TEST(HeatedTissue, FollowsTheExponentialWhateverTheStep) {
  HeatedTissue probe(volume);
  const double steady = power / probe.conductance(), tau = probe.capacity() / probe.conductance();
  for (const int steps : {1, 7, 600}) {
    HeatedTissue t(volume);
    const double time = 0.6;
    for (int i = 0; i < steps; ++i) t.heat(time / steps, power, 0);
    const double warm = steady * (1 - std::exp(-time / tau));
    EXPECT_TRUE(test::held("Heated tissue: warming", std::abs(t.rise() - warm), warm, 1e-12));
    for (int i = 0; i < steps; ++i) t.heat(time / steps, 0, 0);
    EXPECT_TRUE(test::held("Heated tissue: cooling", std::abs(t.rise() - warm * std::exp(-time / tau)), warm, 1e-12));
    EXPECT_EQ(t.dried(), 0);
  }
}

TEST(HeatedTissue, AtTheBoilingPointTheRestOfThePowerDriesIt) {
  const HeatedTissue probe(volume);
  const double loss = probe.conductance(), steady = power / loss, tau = probe.capacity() / loss;
  const double begins = tau * std::log(steady / (steady - boiling_rise)), time = 5;
  for (const int steps : {1, 300}) {
    HeatedTissue t(volume);
    for (int i = 0; i < steps; ++i) t.heat(time / steps, power, 0);
    EXPECT_NEAR(t.rise(), boiling_rise, 1e-10);
    const double expected = (time - begins) * (power - loss * boiling_rise) / probe.water_heat();
    EXPECT_TRUE(test::held("Heated tissue: water boiled off", std::abs(t.dried() - expected), expected, 1e-12));
  }
}

TEST(HeatedTissue, TheDoseIsTheArrheniusIntegral) {
  EXPECT_NEAR(1 / coagulation_rate(33), 51, 1.0) << "about a minute at 70 degrees";
  EXPECT_NEAR(1 / coagulation_rate(43), 0.72, 0.02) << "about a second at 80 degrees";
  HeatedTissue t(volume);
  const double steady = power / t.conductance(), tau = t.capacity() / t.conductance(), time = 0.9;
  double dose = 0;
  const int steps = 54;
  for (int i = 0; i < steps; ++i) dose += t.heat(time / steps, power, 0);
  double fine = 0;
  const int parts = 2000000;
  for (int i = 0; i < parts; ++i)
    fine += time / parts * coagulation_rate(steady * (1 - std::exp(-(i + 0.5) * time / parts / tau)));
  EXPECT_TRUE(test::held("Heated tissue: Arrhenius dose", std::abs(dose - fine), fine, 1e-9));
}

TEST(HeatedTissue, FlowingBloodKeepsItCool) {
  HeatedTissue t(volume);
  const double washing = 1e-6;  // 60 ml/min
  for (int i = 0; i < 6000; ++i) t.heat(step, power, washing);
  EXPECT_NEAR(t.rise(), power / (t.conductance() + 3.8e6 * washing), 1e-12);
  EXPECT_LT(t.rise(), 0.3);
}

/// The example with veins of this strength, and the forceps in the right hand.
struct Veins {
  std::unique_ptr<Simulation> s;
  BridgingVeins* veins = nullptr;
  Instrument* forceps = nullptr;
  int closed = 0, whole_closed = 0, stuck = 0, burnt = 0;

  explicit Veins(const std::string& strength, const std::string& attributes = "") {
    const auto file = std::filesystem::path(INSULA_SOURCE_DIR) / "plugins/bipolar_forceps/example.xml";
    std::ifstream in(file);
    std::stringstream text;
    text << in.rdbuf();
    std::string xml = text.str();
    const auto replace = [&](const std::string& old, const std::string& now) {
      xml.replace(xml.find(old), old.size(), now);
    };
    replace("strength=\"0.2 N\"", "strength=\"" + strength + "\"");
    replace("flat=\"0 0 1\"", "flat=\"0 0 1\" " + attributes);
    s = test::load_text(xml, file);
    if (!s) return;
    veins = s->scene().find_as<BridgingVeins>("veins");
    forceps = s->scene().find_as<Instrument>("bipolar");
  }
  void hold(const Vec3& tip, bool button, int steps = 1) {
    for (int i = 0; i < steps; ++i) {
      s->set_hand(1, test::held_at(*forceps, tip, button));
      s->step();
      for (const Event& e : s->events()) {
        closed += e.kind == "coagulated" && e.id == "bipolar" && e.text == "veins" && e.hand == 1;
        whole_closed += e.kind == "vein_closed";
        stuck += e.kind == "stuck";
        burnt += e.kind == "burn";
      }
    }
  }
  double channel(const char* id) const {
    const ChannelEntry* e = s->channels().find(id);
    if (!e) throw std::runtime_error("no such channel");
    return *e->channel->values(e->item);
  }
};

TEST(BipolarForceps, HeatsOnlyTissueAndOnlyWhileTheButtonIsHeld) {
  Veins t("50 N");
  ASSERT_TRUE(t.s);
  t.hold(Vec3(0.03, 0, 0), true, 30);
  EXPECT_EQ(t.channel("bipolar.temperature_rise"), 0) << "in the air";
  const Vec3 vein = t.veins->site(0)->position;
  t.hold(vein, false, 30);
  EXPECT_EQ(t.channel("bipolar.temperature_rise"), 0);
  EXPECT_EQ(t.forceps->activity(), 0);
  t.hold(vein, true, 30);
  EXPECT_EQ(t.forceps->activity(), 1);
  HeatedTissue alone(volume);
  for (int i = 0; i < 30; ++i) alone.heat(step, power, 0);
  EXPECT_NEAR(t.channel("bipolar.temperature_rise"), alone.rise(), 1e-9);
  t.hold(Vec3(0.03, 0, 0), true);
  EXPECT_EQ(t.channel("bipolar.temperature_rise"), 0) << "other tissue, which is cold";
}

TEST(BipolarForceps, ClosesAWholeVeinWhichThenDoesNotBleed) {
  Veins t("50 N");
  ASSERT_TRUE(t.s);
  const Vec3 vein = t.veins->site(0)->position;
  t.hold(vein, true, 90);
  EXPECT_EQ(t.closed, 1);
  EXPECT_EQ(t.whole_closed, 1) << "a vein that is to be kept";
  EXPECT_FALSE(t.veins->site(0));
  EXPECT_GE(t.veins->dose(0), 1);
  EXPECT_EQ(t.channel("bipolar.dose"), 0) << "nothing is left to close";
}

TEST(BipolarForceps, ClosesStumpsOneByOne) {
  Veins t("0.0001 N", R"(power_under_blood="1")");  // the veins tear in the first step
  ASSERT_TRUE(t.s);
  t.hold(Vec3(0.03, 0, 0), false, 2);
  const int stumps = 2 * t.veins->count();
  ASSERT_EQ(t.veins->open_stumps(), stumps);
  for (int k = 0; k < t.veins->site_count(); ++k) {
    const auto site = t.veins->site(k);
    if (!site) continue;
    t.hold(site->position, false, 2);
    t.hold(site->position, true, 80);
  }
  EXPECT_EQ(t.closed, stumps);
  EXPECT_EQ(t.whole_closed, 0);
  EXPECT_EQ(t.veins->open_stumps(), 0);
  EXPECT_EQ(t.channel("veins.rate"), 0);
  const double lost = t.channel("veins.lost");
  t.hold(Vec3(0.03, 0, 0), false, 30);
  EXPECT_EQ(t.channel("veins.lost"), lost);
  t.s->reset();
  EXPECT_EQ(t.veins->dose(1), 0);
}

TEST(BipolarForceps, UnderBloodTheCurrentGoesPastTheTissue) {
  Veins t("0.0001 N");
  ASSERT_TRUE(t.s);
  t.hold(Vec3(0.03, 0, 0), false, 1200);  // the field fills
  const auto stump = t.veins->site(1);
  ASSERT_TRUE(stump && t.veins->covers(stump->position));
  t.hold(stump->position, true, 240);
  EXPECT_EQ(t.closed, 0);
  HeatedTissue shunted(volume);
  for (int i = 0; i < 240; ++i) shunted.heat(step, 0.2 * power, 0);
  EXPECT_NEAR(t.channel("bipolar.temperature_rise"), shunted.rise(), 1e-9);
}

TEST(BipolarForceps, TooLongACurrentSticksToTheTips) {
  Veins t("50 N");
  ASSERT_TRUE(t.s);
  const Vec3 vein = t.veins->site(0)->position;
  t.hold(vein, true, 600);
  EXPECT_EQ(t.stuck, 1);
  EXPECT_EQ(t.forceps->activity(), 0) << "dry tissue carries no current";
  EXPECT_NEAR(t.channel("bipolar.dried"), 0.3, 0.01);
}

TEST(BipolarForceps, TellsOnceThatASparedSurfaceIsBurnt) {
  Veins t("50 N", R"(spare="lower_surface")");
  ASSERT_TRUE(t.s);
  const Surface* lower = t.s->scene().find_as<Surface>("lower_surface");
  t.hold(lower->positions().front(), true, 200);
  EXPECT_EQ(t.burnt, 1);
}

TEST(BipolarForceps, ReplaysWithTheSameBits) {
  Veins t("0.0001 N");
  ASSERT_TRUE(t.s);
  std::vector<double> first, second;
  for (auto* kept : {&first, &second}) {
    t.s->reset();
    t.hold(Vec3(0.03, 0, 0), false, 2);
    const Vec3 stump = t.veins->site(1) ? t.veins->site(1)->position : Vec3::Zero();
    for (int i = 0; i < 60; ++i) {
      t.hold(stump, i > 10);
      kept->push_back(t.channel("bipolar.temperature_rise"));
      t.forceps->append_state(*kept);
      t.veins->append_state(*kept);
    }
  }
  EXPECT_EQ(first, second);
}

}  // namespace
}  // namespace insula
