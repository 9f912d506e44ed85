// SPDX-License-Identifier: GPL-3.0-or-later
// Pulse wave, exact volumes, prescribed and fed pressure against closed forms.
#include "plugins/pressure/pressure.h"

#include <gtest/gtest.h>

#include "core/base/random.h"
#include "core/testing/held.h"
#include "plugins/pressure/shell_for_test.h"

namespace insula {
namespace {

using test::mmHg;

TEST(PulseWave, RunsFromZeroToOneWithTheMeanItSays) {
  const PulseWave wave;
  double sum = 0, least = 1, most = 0;
  constexpr int n = 4096;  // the mean of a trigonometric polynomial is that of its samples
  for (int i = 0; i < n; ++i) {
    const double v = wave.value(double(i) / n);
    sum += v;
    least = std::min(least, v);
    most = std::max(most, v);
  }
  EXPECT_NEAR(sum / n, wave.mean(), 1e-14);
  EXPECT_NEAR(wave.value(0), 0, 1e-14);
  EXPECT_NEAR(wave.value(wave.peak()), 1, 1e-14);
  EXPECT_GE(least, -1e-14);
  EXPECT_LE(most, 1 + 1e-14);
  EXPECT_NEAR(wave.value(0.3), wave.value(1.3), 1e-14);
  EXPECT_GT(wave.mean(), 0.3);
  EXPECT_LT(wave.mean(), 0.45);
}

TEST(StarMesh, SolvesAsGaussDoesAndKeepsTinyConductances) {
  // A chain 1 - 0 - 2 with a leak of 1e-20 at 2 beside links of 1e-6.
  StarMesh m;
  m.clear(3);
  m.link(0, 1, 1e-6);
  m.link(0, 2, 2e-6);
  m.ground(2, 1e-20, 500);
  m.source(1, 3e-18);
  for (int k = 0; k < 3; ++k) m.eliminate(k);
  double p[3] = {};
  for (int k = 2; k >= 0; --k) p[k] = m.pressure(k, p, 0);
  EXPECT_NEAR(p[2], 500 + 3e-18 / 1e-20, 1e-10);
  EXPECT_NEAR(p[1] - p[2], 3e-18 * (1e6 + 0.5e6), 1e-10);
}

struct Sphere : test::TestScene {
  BloodPressure* pressure = nullptr;
  explicit Sphere(const std::string& attributes, const std::string& wall = "stiffness=\"50 N/m\"", int levels = 2) {
    folder.write("meshes/ball.obj", test::obj_text(test::ball(Vec3(0.04, -0.01, 0.02), 0.004, levels)));
    load(fmt::format(R"(<scene time_step="10 ms"><solver tolerance="1e-14 m"/>
  <shell_body id="artery" mesh="meshes/ball.obj" mesh_unit="m"><test_wall {}/></shell_body>
  <pressure id="p" on="artery" {}/></scene>)",
                     wall, attributes));
    if (s) pressure = &get<BloodPressure>("p");
  }
};

TEST(Chambers, AddUpAndAreClosedEachForItself) {
  ShellBody body;
  WallModel model;
  model.wall = test::ball(Vec3(0.04, -0.01, 0.02), 0.004, 3);
  model.regions = {"a", "b", "c", "between"};
  for (const Vec3& x : model.wall.vertices) {  // three sectors that meet at the poles, and a belt that belongs to none
    const Vec3 d = x - Vec3(0.04, -0.01, 0.02);
    const double angle = std::atan2(d.y(), d.x());
    model.vertex_region.push_back(std::abs(d.z()) < 4e-4 ? 3 : angle < -1 ? 0 : angle < 1 ? 1 : 2);
  }
  body.set_model(model);
  Diagnostics diagnostics;
  PrepareContext context{diagnostics, 0.01};
  body.prepare(context);
  Chambers chambers;
  chambers.build(body, {{"a"}, {"b"}, {"c"}});
  ASSERT_EQ(chambers.count(), 3);
  Random random(7);
  VecX q = body.q(), d(q.size());
  for (int i = 0; i < q.size(); ++i) {
    q[i] += 2e-4 * random.uniform(-1, 1);
    d[i] = random.uniform(-1, 1);
  }
  double whole = 0;
  for (const auto& t : model.wall.triangles) {
    const auto x = [&](int k) -> Vec3 { return q.segment<3>(3 * t[std::size_t(k)]) - Vec3(0.04, -0.01, 0.02); };
    whole += x(0).dot(x(1).cross(x(2))) / 6;
  }
  double sum = 0;
  for (int c = 0; c < 3; ++c) {
    sum += chambers.volume(c, q);
    EXPECT_GT(chambers.volume(c, q), 0.1 * whole);
    std::vector<Vec3> g;
    chambers.gradient(c, q, g);
    Vec3 force = Vec3::Zero(), moment = Vec3::Zero();
    double slope = 0, size = 0;
    for (std::size_t i = 0; i < g.size(); ++i) {
      const int v = chambers.nodes(c)[i];
      force += g[i];
      moment += q.segment<3>(3 * v).cross(g[i]);
      slope += g[i].dot(d.segment<3>(3 * v));
      size += g[i].norm();
    }
    EXPECT_TRUE(test::held("a chamber pushes nowhere", force.norm(), size, 1e-13));
    EXPECT_TRUE(test::held("a chamber turns nothing", moment.norm(), size * q.norm(), 1e-13));
    const double e = 1e-7;
    EXPECT_NEAR((chambers.volume(c, q + e * d) - chambers.volume(c, q - e * d)) / (2 * e), slope,
                1e-8 * std::abs(slope) + 1e-13);
  }
  EXPECT_NEAR(sum, whole, 1e-13 * whole);
}

// The sum of the volumes has the second derivative of the closed surface, where all pressures are equal.
TEST(Chambers, SecondDerivativeIsThatOfTheVolume) {
  ShellBody body;
  WallModel model;
  model.wall = test::ball(Vec3(0.04, -0.01, 0.02), 0.004, 3);
  model.regions = {"a", "b"};
  for (const Vec3& x : model.wall.vertices) model.vertex_region.push_back(x.x() < 0.041 ? 0 : 1);
  body.set_model(model);
  Diagnostics diagnostics;
  PrepareContext context{diagnostics, 0.01};
  body.prepare(context);
  Chambers chambers;
  chambers.build(body, {{"a"}, {"b"}});
  std::vector<std::pair<int, int>> pairs;
  for (const auto& t : model.wall.triangles)
    for (std::size_t k = 0; k < 3; ++k) pairs.emplace_back(t[k], t[(k + 1) % 3]);
  // Every seventh node is fixed and has no block.
  std::vector<int> free_of_node;
  int free_count = 0;
  for (int i = 0; i < body.nodes(); ++i) free_of_node.push_back(i % 7 == 0 ? -1 : free_count++);
  std::erase_if(pairs, [&](const auto& p) { return p.first % 7 == 0 || p.second % 7 == 0; });
  for (auto& [i, j] : pairs) i = free_of_node[std::size_t(i)], j = free_of_node[std::size_t(j)];
  BlockMatrix a;
  a.set_pattern(free_count, pairs);
  a.set_zero();
  chambers.bind(a, free_of_node);
  Random random(11);
  VecX q = body.q(), d = VecX::Zero(q.size()), packed = VecX::Zero(3 * free_count), product = packed;
  for (int i = 0; i < body.nodes(); ++i)
    for (int c = 0; c < 3; ++c) {
      q[3 * i + c] += 2e-4 * random.uniform(-1, 1);
      if (const int b = free_of_node[std::size_t(i)]; b >= 0) packed[3 * b + c] = d[3 * i + c] = random.uniform(-1, 1);
    }
  const double pressure[] = {1e4, 1e4};
  chambers.add_second_derivative(q, pressure, -0.5, a);
  a.add_product(packed.data(), product.data());
  VecX change = VecX::Zero(q.size());  // the gradient is quadratic, so its difference is exact
  std::vector<Vec3> g;
  constexpr double e = 1e-3;
  for (int c = 0; c < 2; ++c)
    for (const double side : {-1.0, 1.0}) {
      chambers.gradient(c, q + side * e * d, g);
      for (std::size_t i = 0; i < g.size(); ++i)
        change.segment<3>(3 * chambers.nodes(c)[i]) += side / (2 * e) * pressure[0] * g[i];
    }
  VecX wanted = VecX::Zero(3 * free_count);
  for (int i = 0; i < body.nodes(); ++i)
    if (const int b = free_of_node[std::size_t(i)]; b >= 0) wanted.segment<3>(3 * b) = -0.5 * change.segment<3>(3 * i);
  EXPECT_TRUE(test::held("gradient of the load", (product - wanted).norm(), wanted.norm(), 1e-11));
}

TEST(Pressure, OnlyTheExcessOverTheMeanLoadsAWallWithoutTension) {
  Sphere t(R"(systolic="130 mmHg" diastolic="70 mmHg" heart_rate="60 1/min")");
  ASSERT_TRUE(t.pressure) << t.messages;
  double sum = 0, most = -1e9, least = 1e9, last = t.pressure->wave_mean(), area = 0;
  for (int i = 0; i < 100; ++i) {  // one beat
    t.run(1);
    const double now = t.pressure->pressure(0), p = now - t.pressure->wave_mean();
    // The row's force is the change of pressure on one area, the same in all steps.
    const double force = t.s->problem().lambda[0];
    if (area == 0 && std::abs(now - last) > 1) area = force / (now - last);
    if (area != 0) {
      EXPECT_NEAR(force / area, now - last, 1e-9);
    }
    std::vector<Vec3> g;
    t.pressure->chambers().gradient(0, t.shell().q(), g);
    for (std::size_t v = 0; v < g.size(); ++v)
      ASSERT_LT((t.shell().filling.segment<3>(3 * t.pressure->chambers().nodes(0)[v]) - p * g[v]).norm(),
                1e-12 * now * g[v].norm());
    last = now;
    sum += p;
    most = std::max(most, p);
    least = std::min(least, p);
  }
  EXPECT_GT(area, 0);
  EXPECT_NEAR(sum / 100, 0, 1e-8);
  EXPECT_NEAR(most - least, 60 * mmHg, 0.2 * mmHg);  // samples may miss the peak
  EXPECT_NEAR(t.pressure->heart_phase(), t.pressure->phase(), 0);
}

TEST(Pressure, BalancesTheWallsSprings) {
  Sphere t(R"(systolic="110 mmHg" diastolic="110 mmHg" imaged_at="90 mmHg")", "stiffness=\"20 N/m\"");
  ASSERT_TRUE(t.pressure) << t.messages;
  t.run(40);
  const double p = 20 * mmHg;
  std::vector<Vec3> g;
  t.pressure->chambers().gradient(0, t.shell().q(), g);
  for (std::size_t i = 0; i < g.size(); ++i) {
    const int v = t.pressure->chambers().nodes(0)[i];
    const Vec3 u = t.shell().q().segment<3>(3 * v) - t.shell().rest_nodes()[std::size_t(v)];
    EXPECT_TRUE(test::held("pressure against the wall's springs", (20 * u - p * g[i]).norm(), (p * g[i]).norm(), 1e-9))
        << v;
  }
  EXPECT_GT(t.pressure->volume(0), 1.005 * t.pressure->rest_volume(0));
}

TEST(Pressure, SphereOfMembraneSwellsAsLaplaceSays) {
  // Tension per length at rest T = p0 r0 / 2 + k (r / r0 - 1), k = E t / (1 - nu), and p r^2 = 2 T r0.
  constexpr double radius = 0.004, young = 1e6, poisson = 0.45, thickness = 3e-4;
  test::TestScene t;
  t.folder.write("meshes/ball.obj", test::obj_text(test::ball(Vec3(0.04, -0.01, 0.02), radius, 3)));
  t.load(R"(<scene time_step="10 ms"><shell_body id="artery" mesh="meshes/ball.obj" mesh_unit="m">
    <membrane thickness="0.3 mm" young="1 MPa" poisson="0.45" density="1.1 g/cm3"/></shell_body>
  <pressure id="p" on="artery" systolic="95 mmHg" diastolic="95 mmHg" imaged_at="93 mmHg"/></scene>)");
  ASSERT_TRUE(t.s) << t.messages;
  const auto& p = t.get<BloodPressure>("p");
  t.run(300);
  const double swelling = p.volume(0) / p.rest_volume(0) - 1;
  const double k = young * thickness / (1 - poisson);
  double s = 1;  // r / r0
  for (int i = 0; i < 100; ++i) s = 1 + (95 * s * s - 93) * mmHg * radius / (2 * k);
  EXPECT_DOUBLE_EQ(*p.chamber_volume.values(0), p.volume(0) / p.rest_volume(0));
  EXPECT_TRUE(test::held("swelling of a sphere (Laplace)", std::abs(swelling - (s * s * s - 1)), s * s * s - 1, 0.02));
}

/// Feeds every chamber from one pressure, and joins chambers to each other.
struct Feed final : ChamberFeed {
  double conductance = 1e-6, joint = 0, pressure = 100 * mmHg, at = 90 * mmHg;
  double reference(int) const override { return at; }
  void reduce(const StepContext&, StarMesh& m) override {
    for (int i = 0; i < m.nodes(); ++i) m.ground(i, conductance, pressure);
    for (int i = 1; i < m.nodes(); ++i) m.link(0, i, joint);
  }
  void settle(const StepContext&, const double* p, const double* y) override {
    for (int i = 0; i < 2; ++i) {
      seen[i] = p[i];
      yields[i] = y[i];
    }
  }
  double seen[2] = {}, yields[2] = {};
};

/// Two separate tubes, so two chambers that touch nowhere.
struct Pair : test::TestScene {
  Feed feed;
  BloodPressure* pressure = nullptr;
  Pair() {
    test::TestVessel v;
    v.add_tube("one", "inlet", "middle", Vec3(0, 0, 0), 0.002, 0.01);
    v.add_tube("two", "middle", "outlet", Vec3(0.01, 0, 0), 0.0015, 0.012);
    v.write(folder);
    load(R"(<scene time_step="10 ms"><solver tolerance="1e-15 m" max_sweeps="2000"/>
  <shell_body id="artery" wall="meshes/vessel.json"><test_wall stiffness="20 N/m"/></shell_body>
  <pressure id="p" on="artery"/></scene>)");
    if (!s) return;
    pressure = &get<BloodPressure>("p");
    pressure->set_feed(&feed);
  }
  void push(int region, double newton) const {  // outwards along x and back: squeezes or widens
    auto& body = shell();
    for (int i = 0; i < body.nodes(); ++i)
      if (body.model().vertex_region[std::size_t(i)] == region)
        body.external[3 * i] = (body.rest_nodes()[std::size_t(i)].x() > (region ? 0.01 : 0.0) ? 1 : -1) * newton;
  }
};

TEST(Pressure, OpenChamberTakesThePressureOfItsFeed) {
  Pair t;
  ASSERT_TRUE(t.pressure) << t.messages;
  t.run(30);
  for (int c = 0; c < 2; ++c) {
    EXPECT_NEAR(t.pressure->pressure(c), t.feed.pressure, 1e-5);
    EXPECT_NEAR(t.feed.seen[c], t.feed.pressure, 1e-5);
    EXPECT_NEAR(t.pressure->fluid(c), t.pressure->volume(c), 1e-9 * t.pressure->volume(c));
  }
}

TEST(Pressure, FillsAtTheRateOfItsConductance) {
  // dV/dt = G (feed - p), V = C (p - reference) for a wall that yields by C: implicit Euler in closed form for the
  // first step.
  Pair t;
  ASSERT_TRUE(t.pressure) << t.messages;
  t.feed.conductance = 1e-12;
  t.run(1);
  for (int c = 0; c < 2; ++c) {
    std::vector<Vec3> g;
    VecX rest = VecX::Zero(3 * t.shell().nodes());
    for (int i = 0; i < t.shell().nodes(); ++i) rest.segment<3>(3 * i) = t.shell().rest_nodes()[std::size_t(i)];
    t.pressure->chambers().gradient(c, rest, g);
    double yields = 0;
    for (std::size_t i = 0; i < g.size(); ++i)
      if (!t.shell().fixed()[std::size_t(t.pressure->chambers().nodes(c)[i])])
        yields += g[i].squaredNorm() / (20 + 1e-12 / 1e-4);
    EXPECT_NEAR(t.feed.yields[c], yields, 1e-9 * yields);
    const double hg = 0.01 * t.feed.conductance, p = hg * (t.feed.pressure - t.feed.at) / (yields + hg);
    EXPECT_TRUE(
        test::held("filling through a conductance", std::abs(t.pressure->pressure(c) - t.feed.at - p), p, 1e-8));
  }
}

TEST(Pressure, SealedChambersKeepTheirVolumeAndJoinedOnesTheirSum) {
  Pair t;
  ASSERT_TRUE(t.pressure) << t.messages;
  t.feed.conductance = 0;
  t.push(0, -0.002);
  t.run(40);
  for (int c = 0; c < 2; ++c)
    EXPECT_TRUE(test::held("sealed chambers keep their volume",
                           std::abs(t.pressure->volume(c) - t.pressure->rest_volume(c)), t.pressure->rest_volume(c),
                           1e-9));
  EXPECT_GT(t.pressure->pressure(0), t.feed.at + 100);
  EXPECT_NEAR(t.pressure->pressure(1), t.feed.at, 1e-6);
  t.feed.joint = 1e-6;  // what is squeezed out of one goes into the other
  t.run(60);
  const double v0 = t.pressure->volume(0) - t.pressure->rest_volume(0),
               v1 = t.pressure->volume(1) - t.pressure->rest_volume(1);
  EXPECT_LT(v0, -1e-11);
  EXPECT_NEAR(v0 + v1, 0, 1e-9 * t.pressure->rest_volume(0));
  EXPECT_NEAR(t.pressure->pressure(0), t.pressure->pressure(1), 1e-3);
}

TEST(Pressure, RowsAreTheDerivativeOfTheirViolation) {
  // Also where rows mix chambers: the second holds a share of the first.
  Pair t;
  ASSERT_TRUE(t.pressure) << t.messages;
  t.feed.conductance = 1e-13;
  t.feed.joint = 1e-12;
  t.run(5);
  ConstraintProblem problem;
  ConstraintBuilder builder(problem, t.s->bodies());
  StepContext context;
  context.h = t.s->h();
  t.pressure->detect(context);
  ShellBody& body = t.shell();
  const VecX q = body.q();
  Random random(3);
  VecX d(q.size());
  for (int i = 0; i < d.size(); ++i) d[i] = random.uniform(-1, 1);
  double violation[2][2], slope[2] = {};
  for (const int side : {0, 1}) {
    const double e = side ? 1e-7 : -1e-7;
    body.q() = q + e * d;
    builder.clear();
    t.pressure->build(context, builder);
    builder.finish();
    ASSERT_EQ(problem.rows, 2);
    for (int r = 0; r < 2; ++r) {
      double along = 0;
      for (int k = body.rows.start[std::size_t(r)]; k < body.rows.start[std::size_t(r) + 1]; ++k) {
        along += body.rows.coeff[std::size_t(k)].dot(d.segment<3>(3 * body.rows.block[std::size_t(k)]));
      }
      violation[side][r] = problem.delta_free[std::size_t(r)];
      slope[r] += 0.5 * along;
    }
  }
  for (int r = 0; r < 2; ++r)
    EXPECT_TRUE(
        test::held("rows that mix chambers", std::abs((violation[1][r] - violation[0][r]) / 2e-7 - slope[r]), 1, 1e-8));
  EXPECT_GT(std::abs(slope[1]), 1e-4);
  EXPECT_EQ(body.rows.start[1] - body.rows.start[0], int(t.pressure->chambers().nodes(0).size()));
  EXPECT_EQ(body.rows.start[2] - body.rows.start[1], body.nodes());
}

TEST(Pressure, SaysWhatIsWrong) {
  EXPECT_NE(Sphere(R"(systolic="80 mmHg" diastolic="90 mmHg")").messages.find("diastolic: is above systolic"),
            std::string::npos);
  EXPECT_NE(Sphere(R"(chambers="wal")").messages.find("no region \"wal\"; did you mean \"wall\"?"), std::string::npos);
  EXPECT_NE(Sphere(R"(chambers="wall; wall")").messages.find("named twice"), std::string::npos);
  EXPECT_NE(Sphere(R"(chambers=" ; ")").messages.find("names no region"), std::string::npos);
  test::TestScene open;
  TriMesh m = test::ball(Vec3::Zero(), 0.004, 1);
  m.triangles.pop_back();
  open.folder.write("meshes/ball.obj", test::obj_text(m));
  open.load(R"(<scene><shell_body id="artery" mesh="meshes/ball.obj" mesh_unit="m"><test_wall/></shell_body>
  <pressure on="artery"/><pressure on="artery"/></scene>)");
  EXPECT_NE(open.messages.find("is not closed"), std::string::npos) << open.messages;
  EXPECT_NE(open.messages.find("has a pressure already"), std::string::npos) << open.messages;
}

TEST(Pressure, FollowsCommandsWithinTheirRange) {
  Sphere t(R"(heart_rate="60 1/min" response="0 s")");
  ASSERT_TRUE(t.pressure) << t.messages;
  EXPECT_EQ(t.s->command("ask", "p set_systolic 180"), "");
  EXPECT_EQ(t.s->command("ask", "p set_heart_rate 120"), "");
  for (const char* bad : {"p set_systolic 60", "p set_systolic 5000", "p set_systolic", "p set_diastolic 190",
                          "p set_heart_rate 1e9", "p set_heart_rate nan", "p set_diastolic 100x"})
    EXPECT_NE(t.s->command("ask", bad), "") << bad;
  t.run(1);
  double most = 0;
  const double start = t.pressure->phase();
  for (int i = 0; i < 50; ++i) {
    t.run(1);
    most = std::max(most, t.pressure->pressure(0));
  }
  EXPECT_NEAR(most, 180 * mmHg, 1 * mmHg);
  EXPECT_NEAR(t.pressure->phase(), start, 1e-12);  // twice as fast: half a second is a beat
  t.s->reset();
  t.run(100);
  EXPECT_LE(t.pressure->pressure(0), 120 * mmHg);
}

}  // namespace
}  // namespace insula
