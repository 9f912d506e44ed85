// SPDX-License-Identifier: GPL-3.0-or-later
// Poiseuille's law, a network solved by hand, and dye. What happens to vessels that are shut or torn:
// closed_vessel_test.cpp.
#include "core/testing/held.h"
#include "plugins/blood_flow/network_for_test.h"
#include "tests/figures/figure.h"

namespace insula {
namespace {

using test::Bifurcation;
using test::ml_min;
using test::mmHg;
using test::steady;
using test::Vessel;
constexpr double mu = 3.5e-3;  // Pa s

TEST(BloodFlow, StraightTubeIsPoiseuilles) {
  test::TestVessel v;
  constexpr int around = 24;
  constexpr double r = 0.0015, length = 0.02;
  v.add_tube("parent", "inlet", "outlet", Vec3::Zero(), r, length, around, 20);
  Vessel t;
  t.load_vessel(v, steady, R"(thickness="0 mm" flow="130 ml/min" collateral="0" upstream_drop="0.1")");
  ASSERT_TRUE(t.flow) << t.messages;
  const double side = 2 * r * std::sin(std::numbers::pi / around),
               area = 0.5 * around * r * r * std::sin(2 * std::numbers::pi / around);
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
  EXPECT_NEAR(t.flow->node_pressure(g.stretches[0].from) - t.flow->node_pressure(g.stretches[0].to),
              polygon * 130 * ml_min, 1e-6);

  // With more corners the polygon's law comes to the circle's.
  test::Figure figure("poiseuille", "Resistance of a straight tube against Poiseuille's", "corners of its section",
                      "over 8 mu l / (pi r^4)");
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
    const double ratio =
        (v_n.flow->node_pressure(stretch.from) - v_n.flow->node_pressure(stretch.to)) / (130 * ml_min) / circle;
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
    const double open = (o.bed * pv + o.collateral * p) / (o.bed + o.collateral),
                 r = series(k + 1) + 1 / (o.bed + o.collateral);
    num += open / r;
    den += 1 / r;
  }
  const double junction = num / den;
  EXPECT_NEAR(t.flow->node_pressure(g.stretches[0].to), junction, 1e-9 * junction);
  EXPECT_NEAR(t.flow->node_pressure(g.stretches[3].middle), junction, 1e-9 * junction)
      << "nothing flows into a sac at rest";
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
  EXPECT_TRUE(test::held("split of the flow by area",
                         std::abs(t.flow->outlets()[0].rest_flow / t.flow->outlets()[1].rest_flow - ratio), ratio,
                         1e-12));
  EXPECT_NEAR(t.state("superior").pressure, t.flow->reference(1), 1e-3);
  EXPECT_GT(t.state("superior").pressure, 0.8 * 93 * mmHg);
  EXPECT_LT(t.state("superior").pressure, 0.93 * 93 * mmHg);
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
    Vessels vessels(*t.s);
    for (const VesselState& v : vessels.now()) most = std::max(most, v.dye);
  }
  EXPECT_LE(most, 1);
  EXPECT_LT(t.state("parent").dye, 0.1);
  EXPECT_LT(t.state("superior").dye, 0.1);
}

TEST(BloodFlow, PulsatesWithoutLosingBlood) {
  Bifurcation t(R"(heart_rate="60 1/min")");
  ASSERT_TRUE(t.flow) << t.messages;
  t.run(300);
  for (int c = 0; c < 4; ++c)
    EXPECT_TRUE(test::held("no blood is lost", std::abs(t.pressure->fluid(c) - t.pressure->volume(c)),
                           t.pressure->volume(c), 1e-6));
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
  EXPECT_NE(messages(same, R"(flow="2000 ml/min" viscosity="20 mPa s")").find("so much does not pass"),
            std::string::npos);
  EXPECT_NE(
      messages([](test::TestVessel& v) { v.json["centrelines"][0]["to"] = "nowhere"; }, "").find("one opening only"),
      std::string::npos);
  EXPECT_NE(
      messages([](test::TestVessel& v) { v.json["centrelines"] = nlohmann::json::array(); }, "").find("centreline"),
      std::string::npos);
  EXPECT_NE(messages(
                [](test::TestVessel& v) {
                  v.json["centrelines"][0]["from"] = "a";
                  v.json["centrelines"][0]["to"] = "b";
                },
                "")
                .find("leads to no opening"),
            std::string::npos);
}

}  // namespace
}  // namespace insula
