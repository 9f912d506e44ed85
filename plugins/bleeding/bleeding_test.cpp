// SPDX-License-Identifier: GPL-3.0-or-later
// The field's shape, the balance of blood, what tears the wall and what stops it.
#include "plugins/bleeding/bleeding.h"

#include <gtest/gtest.h>

#include "core/sim/report.h"
#include "core/testing/held.h"
#include "core/testing/held_tool.h"
#include "plugins/pressure/shell_for_test.h"
#include "tests/figures/figure.h"

namespace insula {
namespace {

constexpr double mmHg = 133.322387415, ml = 1e-6, h = 0.01;

TEST(Bowl, HoldsAParaboloid) {
  const Bowl bowl{0.012, 0.02};
  EXPECT_NEAR(bowl.capacity(), std::numbers::pi * 0.012 * 0.012 * 0.02 / 2, 1e-18);
  EXPECT_EQ(bowl.height(0), 0);
  EXPECT_NEAR(bowl.height(bowl.volume(0.007)), 0.007, 1e-15);
  EXPECT_NEAR(bowl.height(10 * bowl.capacity()), 0.02, 1e-15);
  // dV/dh is the area of the blood's surface.
  const double r2 = 0.012 * 0.012 * 0.007 / 0.02, e = 1e-6;
  EXPECT_NEAR((bowl.volume(0.007 + e) - bowl.volume(0.007 - e)) / (2 * e), std::numbers::pi * r2, 1e-12);
}

struct Field : test::TestScene {
  BloodFlow* flow = nullptr;
  Bleeding* bleeding = nullptr;
  Instrument* tool = nullptr;
  /// A vessel with a sac; its upper part is the bleb. `extra` adds elements, `attributes` go to the bleeding.
  explicit Field(const std::string& attributes = "", const std::string& extra = "",
                 const std::string& pressure = R"(systolic="93 mmHg" diastolic="93 mmHg")") {
    test::TestVessel v;
    v.add_tube("parent", "inlet", "bifurcation", Vec3(0, 0, 0), 0.0014, 0.014, 12, 14);
    v.add_tube("superior", "bifurcation", "superior_outlet", Vec3(0.01, 0, 0), 0.0011, 0.012, 12, 12);
    v.add_tube("sac", "bifurcation", "dome", Vec3(0.03, 0, 0), 0.002, 0.006, 12, 6);
    v.json["regions"].push_back("bleb");
    for (std::size_t i = 0; i < v.wall.vertices.size(); ++i)
      if (v.wall.vertices[i].x() > 0.025 && v.wall.vertices[i].z() > 0.0045) v.json["vertex_region"][i] = 3;
    v.write(folder);
    folder.write("meshes/tube/tube.urdf", test::test_tool_urdf(0.0008));
    folder.write("meshes/tube/tool.json", test::test_tool_json(0, 0.0005));
    folder.write("meshes/knife/tube.urdf", test::test_tool_urdf(0.0008));
    folder.write("meshes/knife/tool.json", test::test_tool_json(0.0005, 0));
    load(fmt::format(R"(<scene time_step="10 ms"><solver tolerance="1e-12 m" max_sweeps="1000"/>
  <bleeding id="b" on="artery" flow="flow" origin="0 0 -20 mm" {}/>
  <shell_body id="artery" wall="meshes/vessel.json"><test_wall stiffness="200 N/m"/><surface id="wall"/></shell_body>
  <blood_flow id="flow" pressure="p"/><pressure id="p" on="artery" {} chambers="parent; superior; sac bleb"/>{}</scene>)",
                     attributes, pressure, extra));
    if (!s) return;
    flow = &get<BloodFlow>("flow");
    bleeding = &get<Bleeding>("b");
    if (!s->instruments().empty()) tool = s->instruments().front();
  }
  void move(const Vec3& tip, bool button, int n = 1) const {
    for (int i = 0; i < n; ++i) {
      s->set_hand(0, test::held_at(*tool, tip, button));
      s->step();
    }
  }
  int events(const std::string& what, int n) const {
    int count = 0;
    for (int i = 0; i < n; ++i) {
      s->step();
      for (const Event& e : s->events()) count += e.kind == what;
    }
    return count;
  }
  BleedingState state() const { return bleeding->bleeding(); }
};
const std::string suction =
    R"(<suction id="tube" model="meshes/tube/tube.urdf" hand="left" home="0 30 0 mm" shaft="0 0 1" flat="1 0 0"/>)";

TEST(Bleeding, FillsTheFieldAtTheTearsRateAndRunsOffAtTheRim) {
  Field t;
  ASSERT_TRUE(t.bleeding) << t.messages;
  t.run(5);
  EXPECT_FALSE(t.state().open);
  EXPECT_EQ(t.state().since, -1);
  ASSERT_EQ(t.s->command("ask", "b rupture"), "");
  EXPECT_EQ(t.events("rupture", 1), 1);
  EXPECT_NE(t.s->command("ask", "b rupture"), "");
  EXPECT_NEAR(t.state().since, 0.06, 1e-12);
  test::Figure figure("bowl", "Blood in the field: height = depth sqrt(volume / capacity)", "blood, ml", "height, mm");
  double out = 0;
  for (int i = 0; i < 500; ++i) {
    t.run(1);
    out += h * t.state().rate;
    if (i % 25 == 24) figure.run("run", out / ml, 1000 * t.state().height);
    figure.law("law", out / ml, 20 * std::sqrt(out / (std::numbers::pi * 0.015 * 0.015 * 0.02 / 2)));
  }
  EXPECT_NEAR(t.state().lost, out, 1e-12 * out);
  EXPECT_NEAR(t.bleeding->volume(), out, 1e-12 * out);
  EXPECT_NEAR(t.state().height, 0.02 * std::sqrt(out / (std::numbers::pi * 0.015 * 0.015 * 0.02 / 2)), 1e-12);
  EXPECT_GT(t.state().rate * 60 / ml, 20);
  // Unattended, the field is full in about ten seconds and no fuller later.
  t.run(700);
  EXPECT_NEAR(t.state().height, 0.02, 1e-12);
  EXPECT_GT(t.state().lost, 8 * ml);
  t.s->reset();
  EXPECT_FALSE(t.bleeding->open());
  EXPECT_EQ(t.flow->tear_flow(2), 0);
  t.run(5);
  EXPECT_EQ(t.state().height, 0);
}

TEST(Bleeding, SuctionTakesWhatItsTipReaches) {
  Field t("", suction);
  ASSERT_TRUE(t.tool) << t.messages;
  ASSERT_EQ(t.s->command("ask", "b rupture"), "");
  t.move(Vec3(0, 0.03, 0), true, 200);  // outside of the field: takes nothing
  EXPECT_NEAR(t.bleeding->volume(), t.state().lost, 1e-12 * t.state().lost);
  double before = t.bleeding->volume();
  t.move(Vec3(0.005, 0.005, -0.019), true, 100);
  const double rate = 45 * ml / 60;
  EXPECT_NEAR(t.bleeding->volume(), before + 1.0 * (t.state().rate - rate), 1e-3 * before);
  before = t.bleeding->volume();
  t.move(Vec3(0.005, 0.005, -0.019), false, 100);
  EXPECT_NEAR(t.bleeding->volume(), before + 1.0 * (t.state().rate - 0.1 * rate), 1e-3 * before);
  // Without a bleed it sucks the field down to its tip and stays there.
  ASSERT_EQ(t.s->command("ask", "b seal"), "");
  t.move(Vec3(0.001, 0, -0.0165), true, 600);
  EXPECT_LE(t.state().height, 0.0035);
  EXPECT_GT(t.state().height, 0.0030);
}

TEST(Bleeding, HeatClosesTheTear) {
  Field t;
  ASSERT_TRUE(t.bleeding) << t.messages;
  EXPECT_FALSE(t.bleeding->site(0)) << "nothing is torn";
  ASSERT_EQ(t.s->command("ask", "b rupture"), "");
  t.run(50);
  const auto site = t.bleeding->site(0);
  ASSERT_TRUE(site);
  EXPECT_EQ(site->washing, t.bleeding->rate());
  EXPECT_GT(site->washing, 0);
  EXPECT_GT(site->position.x(), 0.025) << "the bleb";
  const StepContext context;
  EXPECT_FALSE(t.bleeding->add_dose(context, 0, 0.6));
  EXPECT_TRUE(t.bleeding->open());
  EXPECT_TRUE(t.bleeding->add_dose(context, 0, 0.6));
  const double lost = t.state().lost;
  t.run(20);
  EXPECT_FALSE(t.bleeding->open());
  EXPECT_EQ(t.state().lost, lost);
  EXPECT_FALSE(t.bleeding->site(0));
  ASSERT_EQ(t.s->command("ask", "b rupture"), "");
  t.run(1);
  EXPECT_EQ(t.bleeding->dose(0), 0) << "a new tear";
}

TEST(Bleeding, StopsUnderATemporaryClipAndBeginsAgain) {
  Field t;
  ASSERT_TRUE(t.bleeding) << t.messages;
  ASSERT_EQ(t.s->command("ask", "b rupture"), "");
  EXPECT_EQ(t.events("bleeding_stopped", 100), 0);
  auto& place = t.wall().place;
  for (std::size_t i = 0; i < place.size(); ++i)
    if (const Vec3 x = t.shell().rest_nodes()[i];
        t.shell().model().vertex_region[i] == 0 && x.z() > 0.008 && x.z() < 0.0102 && std::abs(x.x()) > 1e-9)
      place[i].x() = std::copysign(0.00015, x.x());
  EXPECT_EQ(t.events("bleeding_stopped", 190), 0) << "not before two seconds";
  EXPECT_EQ(t.events("bleeding_stopped", 400), 1);
  EXPECT_TRUE(t.state().open);
  place = t.shell().rest_nodes();
  EXPECT_EQ(t.events("bleeding_again", 50), 1);
}

TEST(Bleeding, AWallThatDrawsTakesBackWhatStandsOverTheTear) {
  for (const bool covered : {true, false}) {
    // The tear is 25 mm over the bottom: within a deep and narrow bowl, above the rim of the default one.
    Field t(covered ? R"(radius="5 mm" depth="60 mm")" : "");
    ASSERT_TRUE(t.bleeding) << t.messages;
    ASSERT_EQ(t.s->command("ask", "b rupture"), "");
    t.run(120);
    ASSERT_EQ(covered, t.state().height > 0.027) << t.state().height;
    auto& place = t.wall().place;
    const auto move = [&](double low, double high, const auto& to) {
      for (std::size_t i = 0; i < place.size(); ++i)
        if (const Vec3 x = t.shell().rest_nodes()[i]; x.x() > 0.025 && x.z() > low && x.z() < high)
          place[i].x() = to(x.x());
    };
    move(0.0005, 0.0025, [](double x) {
      return std::abs(x - 0.03) > 1e-9 ? 0.03 + std::copysign(0.00015, x - 0.03) : x;
    });  // the neck is shut
    t.run(400);
    const double pool = t.bleeding->volume(), lost = t.state().lost, inside = t.flow->blood_pressure->fluid(2);
    ASSERT_LT(std::abs(t.flow->blood_pressure->pressure(2)), 1);
    double rate = 0, out = 0;
    const auto swell = [&](double from, double to) {
      for (int i = 1; i <= 110; ++i) {  // the last ones at rest
        const double by = from + (to - from) * std::min(i, 100) / 100;
        move(0.0035, 1, [&](double x) { return 0.03 + by * (x - 0.03); });
        t.run(1);
        rate = std::max(rate, t.state().rate);
        out += h * t.flow->tear_flow(2);
        EXPECT_LT(std::abs(t.flow->blood_pressure->pressure(2)), 1 * mmHg);
      }
    };
    swell(1, 1.1);
    const double taken = t.flow->blood_pressure->fluid(2) - inside;
    EXPECT_LT(rate, 0.1 * taken) << "nothing bleeds meanwhile, over a second, but for what swings back at the end";
    rate = 0;
    EXPECT_GT(taken, 1e-9);
    EXPECT_NEAR(taken, -out, 1e-9 * taken);
    // Blood is neither made nor lost: what came in stood in the field before, or was none.
    EXPECT_TRUE(test::held("what flows back through a tear stood over it",
                           std::abs(t.bleeding->volume() - (covered ? pool - taken : pool)), taken, 1e-9));
    EXPECT_NEAR(t.state().lost, covered ? lost - taken : lost, 1e-9 * taken);
    out = 0;
    swell(1.1, 1.01);
    EXPECT_NEAR(out, 0.9 * taken, 0.05 * taken);
    EXPECT_NEAR(t.state().lost, covered ? lost - taken + out : lost, 1e-9 * taken);
    EXPECT_NEAR(t.bleeding->volume(), covered ? pool - taken + out : pool, 1e-9 * taken);
    EXPECT_EQ(covered, rate > 0.5 * taken) << rate;
  }
}

TEST(Bleeding, TearsWhenPressedTooHardAndSoonerByAnEdge) {
  const auto pressed_at = [](const std::string& folder, double step) {
    Field t(R"(force="0.3 N" sharp_force="0.1 N")",
            R"(<dissector id="tool" model="meshes/)" + folder +
                R"(/tube.urdf" hand="left" home="30 0 12 mm" shaft="0 0 1" flat="1 0 0")" +
                (folder == "tube" ? " sharp=\"never\"" : "") + R"(/>
      <contact between="tool artery"/>)");
    EXPECT_TRUE(t.tool) << t.messages;
    if (!t.tool) return -1.0;
    double last = 0;
    for (int i = 0; i < 400; ++i) {
      t.move(Vec3(0.03, 0, 0.0085 - i * step), false);
      double contact = 0;
      for (const ContactPoint& c : t.s->report().contacts)
        contact += (c.normal_force * c.normal + c.tangent_force).norm();
      if (t.bleeding->open()) {
        const Event& rupture = t.s->events().front();
        EXPECT_EQ(rupture.kind, "rupture");
        EXPECT_GT(rupture.value, last);
        // What the contact says is what the region feels.
        EXPECT_TRUE(test::held("force on the bleb = contact", std::abs(rupture.value - contact), contact, 1e-6));
        return rupture.value;
      }
      last = contact;
    }
    return -2.0;
  };
  const double blunt = pressed_at("tube", 2e-5), sharp = pressed_at("knife", 2e-5);
  EXPECT_GT(blunt, 0.3);
  EXPECT_LT(blunt, 0.35);
  EXPECT_GT(sharp, 0.1);
  EXPECT_LT(sharp, 0.15);
}

TEST(Bleeding, BurstsUnderPressure) {
  Field t(R"(burst="140 mmHg")", "", R"(response="0 s")");
  ASSERT_TRUE(t.bleeding) << t.messages;
  EXPECT_EQ(t.events("rupture", 100), 0);
  ASSERT_EQ(t.s->command("ask", "p set_systolic 180"), "");
  EXPECT_EQ(t.events("rupture", 100), 1);
}

TEST(Bleeding, SaysWhatIsWrong) {
  EXPECT_NE(Field(R"(region="blob")").messages.find("no region \"blob\"; did you mean \"bleb\"?"), std::string::npos);
  EXPECT_NE(Field(R"(up="0 0 0")").messages.find("up: must be a direction"), std::string::npos);
  EXPECT_NE(Field(R"(force="0.1 N" sharp_force="0.2 N")").messages.find("sharp_force: is above force"),
            std::string::npos);
  test::TestScene two;
  test::TestVessel v;
  v.add_tube("parent", "inlet", "outlet", Vec3::Zero(), 0.0014, 0.014);
  v.write(two.folder);
  two.load(
      R"(<scene><shell_body id="a" wall="meshes/vessel.json"><test_wall/></shell_body><shell_body id="c" wall="meshes/vessel.json"><test_wall/></shell_body>
  <pressure id="p" on="a"/><blood_flow id="f" pressure="p"/><bleeding on="c" flow="f" region="parent" origin="0 0 0 mm"/></scene>)");
  EXPECT_NE(two.messages.find("is the blood of \"a\", not of \"c\""), std::string::npos) << two.messages;
}

}  // namespace
}  // namespace insula
