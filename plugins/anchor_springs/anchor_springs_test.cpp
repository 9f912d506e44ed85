// SPDX-License-Identifier: GPL-3.0-or-later
// Support of a wall from outside: closed forms of force, creep and regions.
#include <gtest/gtest.h>

#include "core/testing/held.h"
#include "plugins/membrane/shell_for_test.h"
#include "tests/figures/figure.h"

namespace insula {
namespace {

constexpr double side = 0.02;

std::string prepared(ShellBody& body, double stiffness, double damping, const std::string& regions,
                     const test::Wall& wall = {.thickness = 1e-3, .density = 1000}) {
  auto springs = test::builtin().create("anchor_springs");
  dynamic_cast<QuantityParam&>(*springs->find_param("stiffness")).set(stiffness);
  dynamic_cast<QuantityParam&>(*springs->find_param("damping")).set(damping);
  dynamic_cast<Param<std::string>&>(*springs->find_param("regions")).set(regions);
  springs->parent = &body;
  test::add_membrane(body, wall);
  body.children.push_back(std::move(springs));
  return test::finish(body);
}

// Moved as a whole by d the plate is drawn back with k A d, each node by its share.
TEST(AnchorSprings, DrawBackWithModulusTimesAreaTimesDistance) {
  ShellBody body;
  body.set_mesh(test::plate(side, side, 5, 5, test::Cut::shaken));
  ASSERT_EQ(prepared(body, 3e5, 0, ""), "");
  const Vec3 moved(1e-4, -2e-4, 3e-4);
  VecX x = body.q();
  for (int i = 0; i < body.nodes(); ++i) x.segment<3>(3 * i) += moved;
  const VecX f = test::elastic_force(body, x);
  Vec3 sum = Vec3::Zero();
  for (int i = 0; i < body.nodes(); ++i) {
    sum += f.segment<3>(3 * i);
    // Mass and spring share the node's area.
    EXPECT_TRUE(test::held("anchors draw back with k A d, N",
                           (f.segment<3>(3 * i) + 3e5 * body.node_mass()[std::size_t(i)] * moved).norm(), 1, 1e-12));
  }
  EXPECT_LT((sum + 3e5 * side * side * moved).norm(), 1e-12);
  EXPECT_NEAR(body.forces()[1]->energy(x.data()), 0.5 * 3e5 * side * side * moved.squaredNorm(), 1e-15);
}

// The rigid plate is an oscillator under implicit Euler: (m/h^2 + (1 + T/h) k) dq = -k u + m v/h, per area.
TEST(AnchorSprings, WholeFollowsTheDiscretisedOscillator) {
  ShellBody body;
  body.set_mesh(test::plate(side, side, 4, 4, test::Cut::one_way));
  const double k = 2e3, time = 0.03, m = 1, h = 0.005;  // 1000 kg/m3 of 1 mm: 1 kg/m2
  ASSERT_EQ(prepared(body, k, time, ""), "");
  double u = 1e-3, v = 0;
  test::Figure figure("anchors", "A wall let go on its anchors: the damped oscillator in implicit Euler",
                      "step of 5 ms", "displacement, mm");
  for (int i = 0; i < body.nodes(); ++i) body.q()[3 * i + 1] += u;
  for (int n = 0; n < 50; ++n) {
    test::step(body, h);
    const double d = (-k * u + m * v / h) / (m / (h * h) + (1 + time / h) * k);
    u += d;
    v = d / h;
    figure.law("law", n + 1, u * 1e3);
    figure.run("run", n + 1, (body.q()[1] - body.rest_nodes()[0].y()) * 1e3);
    for (int i = 0; i < body.nodes(); ++i)
      ASSERT_NEAR(body.q()[3 * i + 1] - body.rest_nodes()[std::size_t(i)].y(), u, 1e-12) << n;
  }
}

// A place's time constant is what its compliance tells over steps of two lengths: between the wall's own and that of
// the springs.
TEST(AnchorSprings, ShareAPlacesTimeConstantWithTheWall) {
  for (const double stiffness : {1e5, 1e7, 1e9}) {
    const auto opened = [&] {
      auto body = std::make_unique<ShellBody>();
      body->set_mesh(test::plate(side, side, 5, 5, test::Cut::shaken));
      EXPECT_EQ(prepared(*body, stiffness, 20e-3, "",
                         {.thickness = 1e-3, .young = 1e5, .density = 1, .stiffness_damping = 2e-3}),
                "");
      return body;
    };
    const auto compliance = [](ShellBody& body, double h, int node, int axis) {
      test::step(body, h);
      body.rows.clear();
      body.rows.open(0);
      body.rows.add(node, Vec3::Unit(axis));
      body.begin_compliance(body.rows);
      body.solver()->compute_parts();
      double w = 0, free = 0;
      body.add_response(body.rows, &w, 1, &free);
      return w;
    };
    const auto a = opened(), b = opened(), c = opened();
    const double rate = 60, d = 1e-3;
    for (int node : {0, 14, 21}) {
      double elastic = 0, viscous = 0;
      for (int axis = 0; axis < 3; ++axis) {
        const double w = compliance(*a, 1 / rate, node, axis),
                     slope = (compliance(*b, 1 / (rate + d), node, axis) - compliance(*c, 1 / (rate - d), node, axis)) /
                             (2 * d);
        viscous -= slope;
        elastic += w + rate * slope;
      }
      MaterialPoint p;
      p.body = a.get();
      p.count = 1;
      p.node[0] = node;
      p.weight[0] = 1;
      const double told = viscous / elastic;
      EXPECT_TRUE(
          test::held("a place's time constant is that of its compliance, s", a->retardation_time(p) - told, told, 1e-6))
          << stiffness << " " << node;
      EXPECT_GT(a->retardation_time(p), 2e-3);
      EXPECT_LT(a->retardation_time(p), 20e-3);
    }
  }
}

TEST(AnchorSprings, HoldTheirRegionsOnly) {
  const auto model = [] {
    WallModel v;
    v.wall = test::plate(side, side, 4, 4, test::Cut::one_way);
    v.regions = {"parent", "sac"};
    for (const Vec3& x : v.wall.vertices) v.vertex_region.push_back(x.x() > 0.51 * side);
    return v;
  };
  ShellBody body;
  body.set_model(model());
  ASSERT_EQ(prepared(body, 1e5, 0, "sac"), "");
  VecX x = body.q();
  for (int i = 0; i < body.nodes(); ++i) x[3 * i + 2] += 1e-4;
  const VecX f = test::elastic_force(body, x);
  double sum = 0, area = 0;
  for (int i = 0; i < body.nodes(); ++i) sum += f[3 * i + 2];
  for (const auto& t : body.wall_triangles()) area += body.region_of_triangle(t) == 1 ? 0.5 * side * side / 16 : 0;
  EXPECT_NEAR(sum, -1e5 * area * 1e-4, 1e-12);
  EXPECT_GT(area, 0);
  ShellBody wrong;
  wrong.set_model(model());
  EXPECT_NE(prepared(wrong, 1e5, 0, "sax").find("regions: \"sax\" is no region of the wall; did you mean \"sac\"?"),
            std::string::npos);
}

}  // namespace
}  // namespace insula
