// SPDX-License-Identifier: GPL-3.0-or-later
// The network against networks solved by hand and Kirchhoff's law, and the complete circle against measured flows.
#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <numbers>

#include "core/testing/example.h"
#include "plugins/circle_of_willis/cerebral_network.h"

namespace insula {
namespace {

constexpr double ml_min = 1e-6 / 60, mmHg = 133.322387415;
constexpr double mu = 3.5e-3;
constexpr double mean = 93 * mmHg, venous = 8 * mmHg, brain = 717 * ml_min;

CerebralNetwork circle(const std::vector<std::string>& missing = {}) {
  CerebralNetwork n = complete_circle(brain);
  n.viscosity = mu;
  n.venous = venous;
  for (const std::string& name : missing) n.find(name)->radius = 0;
  EXPECT_EQ(n.size_beds(mean), "");
  n.solve(mean);
  return n;
}

double flow(CerebralNetwork& n, const std::string& segment) { return n.find(segment)->flow; }

/// Flow of a territory over that at rest.
double share(const CerebralNetwork& n, const std::string& name) {
  for (const auto& t : n.territories)
    if (t.name == name) return t.flow / t.rest_flow;
  ADD_FAILURE() << name;
  return 0;
}

/// Greatest sum of the flows into a node, over the flow of the brain.
double imbalance(const CerebralNetwork& n) {
  std::vector<double> sum(std::size_t(n.nodes()), 0.0);
  for (const auto& s : n.segments) {
    if (s.from != CerebralNetwork::arteries) sum[std::size_t(s.from)] -= s.flow;
    sum[std::size_t(s.to)] += s.flow;
  }
  for (const auto& a : n.anastomoses) sum[std::size_t(a.a)] -= a.flow, sum[std::size_t(a.b)] += a.flow;
  for (const auto& t : n.territories) sum[std::size_t(t.node)] -= t.flow;
  double worst = 0;
  for (const double q : sum) worst = std::max(worst, std::abs(q) / brain);
  return worst;
}

void shut(CerebralNetwork& n, const std::string& segment) {
  n.find(segment)->lumen = 0;
  n.solve(mean);
}

TEST(CircleOfWillis, IsKirchhoffs) {
  CerebralNetwork n = circle();
  EXPECT_LT(imbalance(n), 1e-12);
  for (auto& a : n.anastomoses) a.conductance = 0.3 * n.territories[1].bed;
  for (const char* name : {"ica_right", "m1_left", "basilar", "p1_right"}) {
    n.find(name)->lumen = 0.3;
    n.solve(mean);
    EXPECT_LT(imbalance(n), 1e-12) << name;
    shut(n, name);
    EXPECT_LT(imbalance(n), 1e-12) << name;
  }
}

TEST(CircleOfWillis, IsTheNetworkSolvedByHand) {
  // A stem, two branches of different length and width between the same nodes, and a bed.
  CerebralNetwork n;
  n.viscosity = mu;
  n.venous = venous;
  n.segments = {{.name = "stem", .from = CerebralNetwork::arteries, .to = 0, .length = 0.1, .radius = 2e-3},
                {.name = "wide", .from = 0, .to = 1, .length = 0.03, .radius = 1.2e-3},
                {.name = "narrow", .from = 0, .to = 1, .length = 0.02, .radius = 0.8e-3}};
  n.territories = {{.name = "bed", .node = 1, .rest_flow = 100 * ml_min}};
  ASSERT_EQ(n.size_beds(mean), "");
  const auto r = [](double l, double radius) { return 8 * mu * l / (std::numbers::pi * std::pow(radius, 4)); };
  const double stem = r(0.1, 2e-3), wide = r(0.03, 1.2e-3), narrow = r(0.02, 0.8e-3);
  const double parallel = wide * narrow / (wide + narrow);
  const double bed = (mean - venous) / (100 * ml_min) - stem - parallel;
  EXPECT_NEAR(1 / n.territories[0].bed, bed, 1e-9 * bed);
  n.solve(mean);
  EXPECT_NEAR(n.territories[0].flow, 100 * ml_min, 1e-9 * 100 * ml_min);
  // A clip leaves a third of the lumen of the wide branch over 2 mm, and the pressure falls.
  n.find("wide")->lumen = 1.0 / 3;
  n.find("wide")->narrow_length = 2e-3;
  n.solve(0.8 * mean);
  const double clipped = r(0.03 + 2e-3 * 8, 1.2e-3), both = clipped * narrow / (clipped + narrow);
  const double q = (0.8 * mean - venous) / (stem + both + bed);
  EXPECT_NEAR(n.territories[0].flow, q, 1e-9 * q);
  EXPECT_NEAR(flow(n, "narrow"), q * both / narrow, 1e-9 * q);
  EXPECT_NEAR(n.pressure(0), 0.8 * mean - q * stem, 1e-9 * mean);
}

TEST(CircleOfWillis, ASymmetricOneHasNoFlowAcross) {
  CerebralNetwork n = circle();
  EXPECT_LT(std::abs(flow(n, "acom")), 1e-12 * brain);
  EXPECT_NEAR(flow(n, "a1_left"), flow(n, "a1_right"), 1e-12 * brain);
}

// Zarrinkoob et al. 2015: of the flow of the brain the carotid arteries have 72 %, the vertebral arteries 28 %, and the
// basilar artery 20 %. The flows of the territories are given; how the circle distributes them to the arteries that
// supply it is not. 717 ml/min are 4.3 ml/s in each carotid and 1.7 ml/s in each vertebral artery.
TEST(CircleOfWillis, SplitsAsMeasured) {
  CerebralNetwork n = circle();
  const double carotid = (flow(n, "ica_left") + flow(n, "ica_right")) / brain;
  const double vertebral = (flow(n, "va_left") + flow(n, "va_right")) / brain;
  EXPECT_NEAR(carotid + vertebral, 1, 1e-9);
  EXPECT_NEAR(carotid, 0.72, 0.02);
  EXPECT_NEAR(vertebral, 0.28, 0.02);
  EXPECT_NEAR(flow(n, "basilar") / brain, 0.20, 0.02);
  EXPECT_NEAR(flow(n, "ica_left") * 1e6, 4.2, 0.2);  // ml/s
  EXPECT_NEAR(flow(n, "va_left") * 1e6, 1.8, 0.2);
  RecordProperty("carotid_percent", std::to_string(100 * carotid));
  RecordProperty("basilar_percent", std::to_string(100 * flow(n, "basilar") / brain));
}

// Alastruey et al. 2007: the anterior communicating artery is the most important collateral behind an internal carotid
// artery that is shut; with it the territories of that side lose little, without it much more.
TEST(CircleOfWillis, TheAnteriorCommunicatingArteryReplacesACarotidArtery) {
  CerebralNetwork with = circle(), no_acom = circle({"acom"}), no_pcom = circle({"pcom_right"}),
                  neither = circle({"acom", "pcom_right"});
  for (CerebralNetwork* n : {&with, &no_acom, &no_pcom, &neither}) {
    shut(*n, "ica_right");
    EXPECT_EQ(flow(*n, "ica_right"), 0);
    EXPECT_LE(share(*n, "mca_superior_left"), 1 + 1e-9);
  }
  const std::string mca = "mca_superior_right";
  EXPECT_GT(share(with, mca), 0.85);
  EXPECT_LT(share(no_acom, mca), share(with, mca) - 0.10);
  EXPECT_LT(share(with, mca) - share(no_pcom, mca), share(with, mca) - share(no_acom, mca));
  EXPECT_NEAR(share(neither, mca), 0, 1e-12);
  // Blood crosses from left to right, and runs back through A1.
  EXPECT_GT(flow(with, "acom"), 0);
  EXPECT_LT(flow(with, "a1_right"), 0);
  EXPECT_LT(flow(with, "pcom_right"), 0);
  RecordProperty("mca_percent_complete", std::to_string(100 * share(with, mca)));
  RecordProperty("mca_percent_without_acom", std::to_string(100 * share(no_acom, mca)));
  RecordProperty("mca_percent_without_pcom", std::to_string(100 * share(no_pcom, mca)));
}

/// A scene of nothing but a circle.
std::unique_ptr<Simulation> scene(const std::string& attributes) {
  return test::load_text("<scene><circle_of_willis id=\"c\" " + attributes + "/></scene>", "scene.xml");
}

TEST(CircleOfWillis, AClosedTrunkLeavesTheCollateralsOfTheSurface) {
  auto s = scene(R"(leptomeningeal="0.3")");
  ASSERT_TRUE(s);
  const double rest = 50e-5 / 60;
  EXPECT_NEAR(s->channel("c.mca_superior_right.perfusion"), rest, 1e-9 * rest);
  EXPECT_NEAR(s->channel("c.aca_left.outflow"), 0.12 * brain, 1e-9 * brain);
  ASSERT_EQ(s->command("ask", "c close m1_right"), "");
  s->step();
  const double fair = s->channel("c.mca_superior_right.perfusion") / rest;
  EXPECT_GT(fair, 0.15);
  EXPECT_LT(fair, 0.30);
  EXPECT_NEAR(s->channel("c.mca_superior_left.perfusion"), rest, 0.01 * rest);
  ASSERT_EQ(s->command("ask", "c open m1_right"), "");
  s->step();
  EXPECT_NEAR(s->channel("c.mca_superior_right.perfusion"), rest, 1e-9 * rest);
  EXPECT_NE(s->command("ask", "c close m9_right"), "");

  auto none = scene(R"(leptomeningeal="0" shut="m1_right")");
  ASSERT_TRUE(none);
  EXPECT_NEAR(none->channel("c.mca_superior_right.perfusion"), 0, 1e-12 * rest);
}

TEST(CircleOfWillis, AVariantHasItsFlowAtRestAndFewerCollaterals) {
  auto s = scene(R"(diameters="p1_left=0.4 pcom_left=1.5 a1_right=0.5")");
  ASSERT_TRUE(s);
  EXPECT_NEAR(s->channel("c.pca_left.outflow"), 0.08 * brain, 1e-9 * brain);
  // The carotid artery feeds a fetal posterior cerebral artery, and the left A1 both anterior cerebral arteries.
  EXPECT_GT(s->channel("c.pcom_left.flow"), 0.5 * 0.08 * brain);
  EXPECT_GT(s->channel("c.a1_left.flow"), 3 * s->channel("c.a1_right.flow"));
  EXPECT_GT(s->channel("c.acom.flow"), 0.05 * brain);
}

std::string messages(const std::string& attributes) {
  return load_simulation_text("<scene><circle_of_willis id=\"c\" " + attributes + "/></scene>", "scene.xml",
                              test::builtin())
      .diagnostics.format();
}

TEST(CircleOfWillis, SaysWhatIsWrong) {
  EXPECT_NE(messages(R"(diameters="acon=0")").find("did you mean \"acom\""), std::string::npos);
  EXPECT_NE(messages(R"(diameters="acom=4")").find("from 0 to 3"), std::string::npos);
  EXPECT_NE(messages(R"(diameters="p2_left=0" leptomeningeal="0")").find("\"pca_left\""), std::string::npos);
  EXPECT_NE(messages(R"(narrowed="m1_right=c.acom.flew")").find("did you mean \"c.acom.flow\""), std::string::npos);
}

TEST(CircleOfWillis, FollowsThePressureOfTheScene) {
  auto s = test::load(std::filesystem::path(INSULA_SOURCE_DIR) / "plugins/circle_of_willis/example.xml");
  ASSERT_TRUE(s);
  const double rest = 50e-5 / 60;
  for (int i = 0; i < 5; ++i) s->step();
  EXPECT_NEAR(s->channel("circle.pca_left.perfusion"), rest, 0.01 * rest);
  ASSERT_EQ(s->command("ask", "pressure set_diastolic 70"), "");
  ASSERT_EQ(s->command("ask", "pressure set_systolic 70"), "");
  for (int i = 0; i < 1500; ++i) s->step();
  // Linear in the pressure: (70 - 8) / (105 - 8).
  EXPECT_NEAR(s->channel("circle.pca_left.perfusion"), rest * 62 / 97, 0.005 * rest);
}

}  // namespace
}  // namespace insula
