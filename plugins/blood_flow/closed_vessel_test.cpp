// SPDX-License-Identifier: GPL-3.0-or-later
// Vessels that are shut, sealed or torn.
#include "core/testing/held.h"
#include "plugins/blood_flow/network_for_test.h"
#include "tests/figures/figure.h"

namespace insula {
namespace {

using test::Bifurcation;
using test::ml_min;
using test::mmHg;
using test::steady;

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
  test::Figure figure("sealed_sac", "Pressure in a sac behind a shut neck: decays in 3 s", "time, s",
                      "pressure over that at first");
  for (int n = 1; n <= 300; ++n) {
    t.run(1);
    figure.law("law", n * 0.01, std::pow(1 / (1 + 0.01 / 3), n));
    if (n % 10 == 0) figure.run("run", n * 0.01, t.state("sac").pressure / before);
  }
  // Implicit Euler of dp/dt = -p / seal_decay with the yielding of each step; the wall of springs is linear but for its
  // shape.
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
  EXPECT_TRUE(test::held("flow comes back when a clip is off",
                         std::abs(t.state("inferior").flow - t.state("inferior").flow_at_rest),
                         t.state("inferior").flow_at_rest, 1e-5));
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
  for (const auto& o : t.flow->outlets())
    out += o.flow - o.collateral * (t.pressure->arterial(0.01) - t.flow->node_pressure(o.node));
  EXPECT_NEAR(t.flow->arterial_flow(), out, 1e-6 * out);
  t.squeeze("parent", 0.008, 0.0102, 0, 0.0003);
  t.run(300);
  EXPECT_LT(t.flow->tear_flow(3), 0.05 * q) << "a temporary clip stops it";
  t.release();
  t.squeeze("sac", 0.0005, 0.0025, 0.03, 0.0003);
  t.run(300);
  EXPECT_LT(t.flow->tear_flow(3), 0.01 * q) << "a closed neck stops it";
}

/// Compliance of a chamber with a wall of springs, m3/Pa, in steps whose pressures are each `ratio` of the one before.
/// It is g . u with k u = g + load / ratio H u, since a step's load, Pa, acts on the shape of the step before. V is a
/// cubic of q, so differences give H u = d(dV/dq) along u exactly.
double yields(const Bifurcation& t, int chamber, double load, double ratio) {
  const Chambers& all = t.pressure->chambers();
  const auto& nodes = all.nodes(chamber);
  const std::size_t n = nodes.size();
  const double k = t.wall().stiffness(), far = 1e5;
  std::vector<Vec3> g(n), u(n), ahead(n), behind(n);
  const auto along = [&](double by, std::vector<Vec3>& out) {
    VecX q = t.shell().q();
    for (std::size_t i = 0; i < n; ++i) q.segment<3>(3 * nodes[i]) += by * u[i];
    all.gradient(chamber, q, out);
  };
  along(0, g);
  for (std::size_t i = 0; i < n; ++i) u[i] = g[i] / k;
  for (int round = 0; round < 12; ++round) {
    along(far, ahead), along(-far, behind);
    for (std::size_t i = 0; i < n; ++i) u[i] = (g[i] + load / ratio * (ahead[i] - behind[i]) / (2 * far)) / k;
  }
  double sum = 0;
  for (std::size_t i = 0; i < n; ++i) sum += g[i].dot(u[i]);
  return sum;
}

TEST(BloodFlow, TornSacThatIsCutOffComesToThePressureOutside) {
  Bifurcation t;
  ASSERT_TRUE(t.flow) << t.messages;
  constexpr double area = 1e-9, h = 0.01;  // a pinhole, so that it takes some steps
  t.flow->set_tear(3, area);
  t.run(10);
  t.squeeze("sac", 0.0005, 0.0025, 0.03, 0.0003);
  t.run(2);
  ASSERT_EQ(t.state("sac").lumen, 0);
  EXPECT_FALSE(t.flow->sealed(3)) << "its tear is an opening";
  test::Figure figure("torn_sac", "A torn sac behind a shut neck, whose wall draws: comes to the pressure outside",
                      "time, s", "pressure, mmHg");
  for (const bool draws : {false, true}) {
    if (draws)
      for (std::size_t i = 0; i < t.wall().place.size(); ++i) {
        Vec3& x = t.wall().place[i];
        if (t.shell().model().vertex_region[i] == 3 && x.z() > 0.003)
          x.head<2>() += 0.02 * (x.head<2>() - Eigen::Vector2d(0.03, 0));
      }
    t.run(2);
    const double first = t.pressure->pressure(3);
    EXPECT_GT((draws ? -1 : 1) * first, 20 * mmHg);
    int straight = 0;
    for (int n = 0; n < 80; ++n) {
      const double before = t.pressure->pressure(3), fluid = t.pressure->fluid(3);
      const double hole = 0.6 * area * std::sqrt(2 / (1060 * std::max(std::abs(before), 10.0)));
      t.run(1);
      const double now = t.pressure->pressure(3);
      // Orifice law, implicit, in both directions of flow.
      ASSERT_NEAR(t.flow->tear_flow(3), hole * now, 1e-12 * std::abs(hole * now) + 1e-24);
      ASSERT_NEAR(t.pressure->fluid(3) - fluid, -h * hole * now, 1e-9 * std::abs(h * hole * now) + 1e-20);
      // The sac yields as its springs do: implicit Euler of C dp/dt = -Q.
      const double ratio = now / before, yielding = yields(t, 3, now - t.flow->reference(3), ratio),
                   law = yielding / (yielding + h * hole);
      if (std::abs(before) > 10) {
        EXPECT_NEAR(ratio, law, 2e-3) << n;
      }
      if (std::abs(before) < 1 && std::abs(before) > 1e-3) {  // to the last digits where the wall is all but at rest
        ++straight;
        EXPECT_TRUE(test::held("a torn sac comes to the pressure outside", std::abs(ratio - law), 1, 1e-6)) << before;
      }
      if (draws) {
        figure.law("law", n * h, law * before / mmHg);
        if (n % 4 == 0) figure.run("run", n * h, now / mmHg);
      }
    }
    EXPECT_GE(straight, 3);
    EXPECT_LT(std::abs(t.pressure->pressure(3)), 1e-6) << (draws ? "drawn by its wall" : "filled");
  }
}

}  // namespace
}  // namespace insula
