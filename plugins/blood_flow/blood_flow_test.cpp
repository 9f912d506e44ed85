// SPDX-License-Identifier: GPL-3.0-or-later
// Poiseuille's law, a network solved by hand, closed vessels, tears and dye.
#include "plugins/blood_flow/blood_flow.h"

#include <gtest/gtest.h>

#include "core/sim/report.h"
#include "core/testing/held.h"
#include "plugins/pressure/shell_for_test.h"
#include "tests/figures/figure.h"

namespace insula {
namespace {

constexpr double mmHg = 133.322387415, ml_min = 1e-6 / 60, mu = 3.5e-3;
const std::string steady = R"(systolic="93 mmHg" diastolic="93 mmHg" heart_rate="60 1/min")";

struct Vessel : test::TestScene {
  BloodPressure* pressure = nullptr;
  BloodFlow* flow = nullptr;
  void load_vessel(const test::TestVessel& v, const std::string& pressure_attributes, const std::string& flow_attributes) {
    v.write(folder);
    // The network first: the order of elements does not matter.
    load(fmt::format(R"(<scene time_step="10 ms"><solver tolerance="1e-14 m" max_sweeps="2000"/>
  <shell_body id="artery" vessel="meshes/vessel.json"><test_wall stiffness="2000 N/m"/></shell_body>
  <blood_flow id="flow" pressure="p" {}/><pressure id="p" on="artery" {}/></scene>)", flow_attributes, pressure_attributes));
    if (!s) return;
    pressure = &get<BloodPressure>("p");
    flow = &get<BloodFlow>("flow");
  }
  /// Presses a region flat across x between two heights, so that its wall's middle surfaces lie `gap` apart.
  void squeeze(const std::string& region, double low, double high, double axis, double gap) const {
    test::TestWall& w = wall();
    const int r = shell().region(region);
    for (std::size_t i = 0; i < w.place.size(); ++i) {
      const Vec3& x = shell().rest_nodes()[i];
      if (shell().model().vertex_region[i] == r && x.z() > low && x.z() < high && std::abs(x.x() - axis) > 1e-9) w.place[i].x() = axis + std::copysign(0.5 * gap, x.x() - axis);
    }
  }
  void release() const { wall().place = shell().rest_nodes(); }
  const VesselState& state(std::string_view id) const {
    for (const VesselState& v : s->report().vessels)
      if (v.id == id) return v;
    throw std::runtime_error("no such stretch");
  }
};

/// A parent that parts into two branches and carries a sac.
struct Bifurcation : Vessel {
  Bifurcation(const std::string& p = steady, const std::string& f = "") {
    test::TestVessel v;
    v.add_tube("parent", "inlet", "bifurcation", Vec3(0, 0, 0), 0.0014, 0.014, 12, 14);
    v.add_tube("superior", "bifurcation", "superior_outlet", Vec3(0.01, 0, 0), 0.0011, 0.012, 12, 12);
    v.add_tube("inferior", "bifurcation", "inferior_outlet", Vec3(0.02, 0, 0), 0.0009, 0.012, 12, 12);
    v.add_tube("sac", "bifurcation", "dome", Vec3(0.03, 0, 0), 0.002, 0.006, 12, 6);
    load_vessel(v, p, f);
  }
};

TEST(BloodFlow, StraightTubeIsPoiseuilles) {
  test::TestVessel v;
  constexpr int around = 24;
  constexpr double r = 0.0015, length = 0.02;
  v.add_tube("parent", "inlet", "outlet", Vec3::Zero(), r, length, around, 20);
  Vessel t;
  t.load_vessel(v, steady, R"(thickness="0 mm" flow="130 ml/min" collateral="0" upstream_drop="0.1")");
  ASSERT_TRUE(t.flow) << t.messages;
  const double side = 2 * r * std::sin(std::numbers::pi / around), area = 0.5 * around * r * r * std::sin(2 * std::numbers::pi / around);
  double conductance = 0;  // of the halves in series
  for (const Branch& b : t.flow->graph().branches) conductance += 1 / b.conductance;
  const double polygon = 2 * mu * std::pow(around * side, 2) / std::pow(area, 3) * length;
  EXPECT_NEAR(conductance, polygon, 1e-9 * polygon);
  // And the circle's law within the polygon's error.
  const double circle = 8 * mu * length / (std::numbers::pi * std::pow(r, 4));
  EXPECT_NEAR(conductance, circle, 0.04 * circle);
  t.run(5);
  EXPECT_NEAR(t.flow->arterial_flow(), 130 * ml_min, 1e-9 * 130 * ml_min);
  const auto& g = t.flow->graph();
  EXPECT_NEAR(t.flow->node_pressure(g.stretches[0].from), 0.9 * 93 * mmHg, 1e-6);
  EXPECT_NEAR(t.flow->node_pressure(g.stretches[0].from) - t.flow->node_pressure(g.stretches[0].to), polygon * 130 * ml_min, 1e-6);

  // With more corners the polygon's law comes to the circle's.
  test::Figure figure("poiseuille", "Resistance of a straight tube against Poiseuille's", "corners of its section", "over 8 mu l / (pi r^4)");
  double last = 1e300;
  for (int n = 8; n <= 64; ++n) {
    const double p = 2 * n * std::sin(std::numbers::pi / n), a = 0.5 * n * std::sin(2 * std::numbers::pi / n);
    figure.law("polygon: 2 mu l perimeter^2 / area^3", n, 2 * p * p / (a * a * a) * std::numbers::pi / 8);
    figure.law("circle", n, 1);
    if (n % 8 != 0) continue;
    test::TestVessel tube;
    tube.add_tube("parent", "inlet", "outlet", Vec3::Zero(), r, length, n, 20);
    Vessel v_n;
    v_n.load_vessel(tube, steady, R"(thickness="0 mm" flow="130 ml/min" collateral="0" upstream_drop="0.1")");
    ASSERT_TRUE(v_n.flow) << v_n.messages;
    v_n.run(5);
    const auto& stretch = v_n.flow->graph().stretches[0];
    const double ratio = (v_n.flow->node_pressure(stretch.from) - v_n.flow->node_pressure(stretch.to)) / (130 * ml_min) / circle;
    figure.run("polygon: 2 mu l perimeter^2 / area^3", n, ratio);
    EXPECT_NEAR(ratio, 2 * p * p / (a * a * a) * std::numbers::pi / 8, 1e-8) << n;
    EXPECT_LT(ratio - 1, last) << n;
    last = ratio - 1;
  }
  EXPECT_LT(last, 0.005);
}

TEST(BloodFlow, NetworkIsTheOneSolvedByHand) {
  Bifurcation t(steady, R"(collateral="0.1")");
  ASSERT_TRUE(t.flow) << t.messages;
  // Another pressure than that of rest: everything is linear, so nodes follow from two equations.
  ASSERT_EQ(t.s->command("ask", "p set_systolic 120"), "");
  ASSERT_EQ(t.s->command("ask", "p set_diastolic 120"), "");
  t.run(1500);
  const auto& g = t.flow->graph();
  const double p = t.pressure->arterial(0.01), pv = 8 * mmHg;
  EXPECT_NEAR(p, 120 * mmHg, 0.01);
  const auto series = [&](int stretch) {
    double r = 0;
    for (const Branch& b : g.branches)
      if (b.stretch == stretch) r += 1 / b.conductance;
    return r;
  };
  // Each branch with its bed and collateral as one source behind one resistance.
  double num = p / (1 / t.flow->upstream() + series(0)), den = 1 / (1 / t.flow->upstream() + series(0));
  for (int k = 0; k < 2; ++k) {
    const auto& o = t.flow->outlets()[std::size_t(k)];
    const double open = (o.bed * pv + o.collateral * p) / (o.bed + o.collateral), r = series(k + 1) + 1 / (o.bed + o.collateral);
    num += open / r;
    den += 1 / r;
  }
  const double junction = num / den;
  EXPECT_NEAR(t.flow->node_pressure(g.stretches[0].to), junction, 1e-9 * junction);
  EXPECT_NEAR(t.flow->node_pressure(g.stretches[3].middle), junction, 1e-9 * junction) << "nothing flows into a sac at rest";
  const double q = (p - junction) / (1 / t.flow->upstream() + series(0));
  EXPECT_TRUE(test::held("a network solved by hand", std::abs(t.flow->arterial_flow() - q), q, 1e-8));
}

TEST(BloodFlow, SplitsTheFlowAtRestByTheOutletsAreas) {
  Bifurcation t;
  ASSERT_TRUE(t.flow) << t.messages;
  t.run(120);
  EXPECT_NEAR(t.state("parent").flow_at_rest, 130 * ml_min, 1e-9 * 130 * ml_min);
  EXPECT_NEAR(t.state("parent").flow, 130 * ml_min, 1e-6 * 130 * ml_min);
  const auto area = [&](int k) { return t.flow->graph().stretches[std::size_t(k)].stations.back().rest.area; };
  const double ratio = std::pow(area(1) / area(2), 1.5);
  EXPECT_TRUE(test::held("split of the flow by area", std::abs(t.flow->outlets()[0].rest_flow / t.flow->outlets()[1].rest_flow - ratio), ratio, 1e-12));
  EXPECT_NEAR(t.state("superior").pressure, t.flow->reference(1), 1e-3);
  EXPECT_GT(t.state("superior").pressure, 0.8 * 93 * mmHg);
  EXPECT_LT(t.state("superior").pressure, 0.93 * 93 * mmHg);
}

TEST(BloodFlow, SacBehindAClosedNeckGoesSoft) {
  Bifurcation t;
  ASSERT_TRUE(t.flow) << t.messages;
  t.run(10);
  EXPECT_FALSE(t.flow->sealed(3));
  const double open = t.state("sac").pressure;
  t.squeeze("sac", 0.0005, 0.0025, 0.03, 0.0003);
  t.run(2);
  ASSERT_TRUE(t.flow->sealed(3));
  EXPECT_EQ(t.state("sac").lumen, 0);
  const double before = t.state("sac").pressure, parent = t.state("parent").pressure;
  test::Figure figure("sealed_sac", "Pressure in a sac behind a shut neck: decays in 3 s", "time, s", "pressure over that at first");
  for (int n = 1; n <= 300; ++n) {
    t.run(1);
    figure.law("law", n * 0.01, std::pow(1 / (1 + 0.01 / 3), n));
    if (n % 10 == 0) figure.run("run", n * 0.01, t.state("sac").pressure / before);
  }
  // Implicit Euler of dp/dt = -p / seal_decay with the yielding of each step; the wall of springs is linear but for its shape.
  EXPECT_NEAR(t.state("sac").pressure / before, std::pow(1 / (1 + 0.01 / 3), 300), 0.01);
  EXPECT_NEAR(t.state("parent").pressure, parent, 1e-3 * parent);
  EXPECT_EQ(t.state("sac").flow, 0);
  t.release();
  t.run(5);
  EXPECT_NEAR(t.state("sac").pressure, open, 1e-3 * open);
}

TEST(BloodFlow, SealedSacIsIncompressibleAndAnOpenOneYields) {
  double change[2];
  for (const bool sealed : {false, true}) {
    Bifurcation t(steady, R"(seal_decay="1000 s")");
    ASSERT_TRUE(t.flow) << t.messages;
    if (sealed) t.squeeze("sac", 0.0005, 0.0025, 0.03, 0.0003);
    t.run(20);
    const double v = t.pressure->volume(3), p = t.pressure->pressure(3);
    for (int i = 0; i < t.shell().nodes(); ++i)
      if (t.shell().model().vertex_region[std::size_t(i)] == 3 && t.shell().rest_nodes()[std::size_t(i)].z() > 0.0035)
        t.shell().external[3 * i] = t.shell().rest_nodes()[std::size_t(i)].x() > 0.03 ? -0.02 : 0.02;
    t.run(20);
    change[sealed] = std::abs(t.pressure->volume(3) - v) / v;
    if (sealed) EXPECT_GT(t.pressure->pressure(3), p + 500);
    else EXPECT_NEAR(t.pressure->pressure(3), p, 1);
  }
  EXPECT_GT(change[0], 1e-4);
  EXPECT_LT(change[1], 2e-3 * change[0] + 4e-4 * change[0] + 2e-7);
}

TEST(BloodFlow, ClipOnABranchOrTheParentStopsItsFlow) {
  Bifurcation t;
  ASSERT_TRUE(t.flow) << t.messages;
  t.squeeze("inferior", 0.005, 0.0072, 0.02, 0.0003);
  t.run(220);
  EXPECT_LT(t.state("inferior").flow, 0.02 * t.state("inferior").flow_at_rest);
  EXPECT_GT(t.state("superior").flow, 0.99 * t.state("superior").flow_at_rest);
  EXPECT_EQ(t.state("inferior").lumen, 0);
  t.release();
  t.squeeze("parent", 0.008, 0.0102, 0, 0.0003);  // a temporary clip
  t.run(220);
  for (const char* id : {"superior", "inferior"}) {
    EXPECT_LT(t.state(id).pressure, 15 * mmHg) << id;
    EXPECT_GT(t.state(id).pressure, 8 * mmHg) << id;
    EXPECT_LT(t.state(id).flow, 0.03 * t.state(id).flow_at_rest) << id;
  }
  EXPECT_LT(t.state("sac").pressure, 15 * mmHg);
  EXPECT_FALSE(t.flow->sealed(3));
  t.release();
  t.run(220);
  EXPECT_TRUE(test::held("flow comes back when a clip is off", std::abs(t.state("inferior").flow - t.state("inferior").flow_at_rest), t.state("inferior").flow_at_rest, 1e-5));
}

TEST(BloodFlow, TearBleedsByTheOrificeLaw) {
  Bifurcation t;
  ASSERT_TRUE(t.flow) << t.messages;
  t.flow->set_tear(3, 0.3e-6);
  t.run(60);
  const double p = t.state("sac").pressure;
  const double q = 0.6 * 0.3e-6 * std::sqrt(2 * p / 1060);
  EXPECT_TRUE(test::held("orifice law of a tear", std::abs(t.flow->tear_flow(3) - q), q, 1e-7));
  EXPECT_GT(q, 30 * ml_min);
  EXPECT_LT(q, 80 * ml_min);
  // What comes in goes out.
  double out = t.flow->tear_flow(3);
  for (const auto& o : t.flow->outlets()) out += o.flow - o.collateral * (t.pressure->arterial(0.01) - t.flow->node_pressure(o.node));
  EXPECT_NEAR(t.flow->arterial_flow(), out, 1e-6 * out);
  t.squeeze("parent", 0.008, 0.0102, 0, 0.0003);
  t.run(300);
  EXPECT_LT(t.flow->tear_flow(3), 0.05 * q) << "a temporary clip stops it";
  t.release();
  t.squeeze("sac", 0.0005, 0.0025, 0.03, 0.0003);
  t.run(300);
  EXPECT_LT(t.flow->tear_flow(3), 0.01 * q) << "a closed neck stops it";
}

TEST(BloodFlow, DyeFillsWhatBloodReachesAndWashesOut) {
  Bifurcation t(R"(heart_rate="60 1/min")");
  ASSERT_TRUE(t.flow) << t.messages;
  t.squeeze("inferior", 0.001, 0.0032, 0.02, 0.0003);
  t.run(100);
  ASSERT_EQ(t.s->command("ask", "flow inject_dye"), "");
  t.run(100);
  EXPECT_LT(t.state("parent").dye, 1e-3);
  t.run(600);
  EXPECT_GT(t.state("parent").dye, 0.9);
  EXPECT_GT(t.state("superior").dye, 0.9);
  EXPECT_GT(t.state("sac").dye, 0.5);
  EXPECT_LT(t.state("inferior").dye, 0.2);
  double most = 0;
  for (int i = 0; i < 1600; ++i) {
    t.run(1);
    for (const VesselState& v : t.s->report().vessels) most = std::max(most, v.dye);
  }
  EXPECT_LE(most, 1);
  EXPECT_LT(t.state("parent").dye, 0.1);
  EXPECT_LT(t.state("superior").dye, 0.1);
}

TEST(BloodFlow, PulsatesWithoutLosingBlood) {
  Bifurcation t(R"(heart_rate="60 1/min")");
  ASSERT_TRUE(t.flow) << t.messages;
  t.run(300);
  for (int c = 0; c < 4; ++c) EXPECT_TRUE(test::held("no blood is lost", std::abs(t.pressure->fluid(c) - t.pressure->volume(c)), t.pressure->volume(c), 1e-6));
  EXPECT_NEAR(t.state("parent").flow, 130 * ml_min, 0.01 * 130 * ml_min);
  const std::uint64_t hash = t.s->state_hash();
  t.s->reset();
  t.run(300);
  EXPECT_EQ(t.s->state_hash(), hash);
}

TEST(BloodFlow, SidewallSacWithoutAJunctionIsFoundByItsPlace) {
  test::TestVessel v;
  v.add_tube("parent", "inlet", "outlet", Vec3::Zero(), 0.0015, 0.02, 12, 20);
  v.add_tube("sac", "neck", "dome", Vec3(0.004, 0, 0.01), 0.002, 0.006, 12, 6);
  Vessel t;
  t.load_vessel(v, steady, "");
  ASSERT_TRUE(t.flow) << t.messages;
  t.run(10);
  const auto& g = t.flow->graph();
  EXPECT_EQ(g.stretches[1].from, g.stretches[0].middle);
  EXPECT_TRUE(g.stretches[1].dead_end);
  EXPECT_NEAR(t.state("sac").pressure, t.state("parent").pressure, 1e-3);
}

TEST(BloodFlow, SaysWhatIsWrong) {
  const auto messages = [](const auto& change, const std::string& f) {
    test::TestVessel v;
    v.add_tube("parent", "inlet", "outlet", Vec3::Zero(), 0.0015, 0.02, 12, 20);
    change(v);
    Vessel t;
    t.load_vessel(v, steady, f);
    return t.messages;
  };
  const auto same = [](test::TestVessel&) {};
  EXPECT_EQ(messages(same, ""), "");
  EXPECT_NE(messages(same, R"(inlet="outle")").find("did you mean \"outlet\"?"), std::string::npos);
  EXPECT_NE(messages(same, R"(flow="2000 ml/min" viscosity="20 mPa s")").find("so much does not pass"), std::string::npos);
  EXPECT_NE(messages([](test::TestVessel& v) { v.json["centrelines"][0]["to"] = "nowhere"; }, "").find("one opening only"), std::string::npos);
  EXPECT_NE(messages([](test::TestVessel& v) { v.json["centrelines"] = nlohmann::json::array(); }, "").find("centreline"), std::string::npos);
  EXPECT_NE(messages([](test::TestVessel& v) { v.json["centrelines"][0]["from"] = "a"; v.json["centrelines"][0]["to"] = "b"; }, "").find("leads to no opening"), std::string::npos);
}

}  // namespace
}  // namespace insula
