// SPDX-License-Identifier: GPL-3.0-or-later
// Walls under pressure against Laplace's law, the pinched cylinder, steps of thickness, free vibration.
#include <gtest/gtest.h>

#include "core/testing/held.h"
#include "plugins/membrane/shell_for_test.h"
#include "tests/figures/figure.h"

namespace insula {
namespace {

using test::Cut;
using test::Wall;
constexpr double pi = std::numbers::pi;

// A prism of N flat panels, Poisson's ratio 0: the chord's tension T = E t (r/r0 - 1) carries p r cos(pi/N). Its angles
// do not change, so bending has no part in it.
TEST(Laplace, PrismFollowsTheDiscretisedLaw) {
  const double radius = 0.002, length = 0.006;
  const int around = 12, along = 6;
  const Wall w{.thickness = 3e-4, .young = 5e5, .poisson = 0};
  auto body = test::shell(test::cylinder(radius, length, around, along), w);
  const double p = 1.6e4;
  const double stiffness = w.young * w.thickness, grown = radius / (1 - p * radius * std::cos(pi / around) / stiffness);
  ASSERT_GT(grown, 1.1 * radius);
  VecX x = body->q();
  for (int i = 0; i < body->nodes(); ++i) x.segment<2>(3 * i) *= grown / radius;
  const VecX f = test::elastic_force(*body, x);
  // p times the gradient of the prism's volume, along the radius; the rings at the ends carry half a row of panels.
  for (int i = 0; i < body->nodes(); ++i) {
    const bool end = i < around || i >= around * along;
    Vec3 out = x.segment<3>(3 * i);
    out.z() = 0;
    const double push = (end ? 0.5 : 1.0) * p * length / along * std::sin(2 * pi / around) * grown;
    EXPECT_TRUE(test::held("inflated prism, T = p r cos(pi/N)", (f.segment<3>(3 * i) + push * out.normalized()).norm(),
                           push, 1e-10))
        << i;
  }
}

/// Radius of a sphere after inflation, mean over its nodes.
double inflated(TriMesh mesh, const Wall& w, double p) {
  auto body = test::shell(std::move(mesh), w);
  test::settle(*body, 40, [&] { test::press(*body, p, body->q()); });
  Vec3 centre = Vec3::Zero();
  double sum = 0;
  for (int i = 0; i < body->nodes(); ++i) centre += body->q().segment<3>(3 * i) / body->nodes();
  for (int i = 0; i < body->nodes(); ++i) sum += (body->q().segment<3>(3 * i) - centre).norm() / body->nodes();
  return sum;
}

// All corners of an icosahedron are alike, so it grows as a whole: p dV = dE with V0 s^3 and E t A0 / (1 - nu) (s -
// 1)^2.
TEST(Laplace, IcosahedronFollowsTheDiscretisedLaw) {
  const Wall w{.thickness = 3e-4, .young = 1e6, .poisson = 0.45};
  const double radius = 0.003, p = 8e3, edge = radius / std::sin(2 * pi / 5), area = 5 * std::sqrt(3.0) * edge * edge,
               volume = 5.0 / 12 * (3 + std::sqrt(5.0)) * edge * edge * edge;
  const double k = 2 * w.young * w.thickness * area / (1 - w.poisson);
  double s = 1;
  for (int i = 0; i < 50; ++i) s = 1 + 3 * p * volume * s * s / k;
  EXPECT_TRUE(test::held("inflated icosahedron, p dV = dE",
                         std::abs(inflated(test::icosphere(radius, 0), w, p) - s * radius), radius, 1e-9));
  EXPECT_GT(s, 1.01);
}

// The sphere: p = 2 t sigma / r with sigma = E / (1 - nu) (r/r0 - 1) per area at rest, so p r^2 = 2 t E / (1 - nu) (r -
// r0).
TEST(Laplace, SphereConverges) {
  const Wall w{.thickness = 1e-4, .young = 1e6, .poisson = 0.45};
  const double radius = 0.003, p = 4e3, k = 2 * w.young * w.thickness / (1 - w.poisson);
  double r = radius;
  for (int i = 0; i < 100; ++i) r = radius + p * r * r / k;
  double last = 1;
  test::Figure figure("sphere", "A sphere inflated, p = 2 t sigma / r, under refinement", "triangles",
                      "growth of the radius over Laplace's");
  for (const int times : {1, 2, 3}) {
    const double growth = (inflated(test::icosphere(radius, times), w, p) - radius) / (r - radius),
                 error = std::abs(growth - 1);
    figure.run("growth", 20 * std::pow(4, times), growth);
    figure.law("Laplace", 20 * std::pow(4, times), 1);
    if (times > 1) {
      EXPECT_LT(error, 0.3 * last) << times;
    }
    last = error;
  }
  EXPECT_LT(last, 0.01);
}

/// Ends of a cylinder along z kept round and centred, free to move along.
class Diaphragms final : public ForceModel {
 public:
  std::vector<int> nodes, slot;
  VecX rest;
  double k = 1e9;
  void couplings(std::vector<std::pair<int, int>>&, Tangent) const override {}
  void bind(const BlockMatrix& a, const std::vector<int>& free) override {
    slot.clear();
    for (int n : nodes) slot.push_back(a.diagonal(free[std::size_t(n)]));
  }
  void linearise(const double* x, double* f, BlockMatrix* m, double, Tangent) override {
    for (std::size_t i = 0; i < nodes.size(); ++i)
      for (int c = 0; c < 3; ++c) {
        const double s = c < 2 ? k : 1e-9 * k;  // a trace of hold along keeps the whole in place
        f[3 * nodes[i] + c] -= s * (x[3 * nodes[i] + c] - rest[3 * nodes[i] + c]);
        if (m) m->block(slot[i])[4 * c] += s;
      }
  }
  double energy(const double*) override { return 0; }
};

/// Deflection under the load of the pinched cylinder with rigid diaphragms, over 1.8248e-5.
double pinched(int around, int along) {
  const double radius = 300, length = 600;
  ShellBody body;
  body.set_mesh(test::cylinder(radius, length, around, along));
  test::add_membrane(body, {.thickness = 3, .young = 3e6, .poisson = 0.3});
  auto ends = std::make_unique<Diaphragms>();
  for (int i = 0; i < around; ++i) {
    ends->nodes.push_back(i);
    ends->nodes.push_back(around * along + i);
  }
  ends->rest.resize(3 * around * (along + 1));
  Diaphragms& hold = *ends;
  hold.parent = &body;
  body.children.push_back(std::move(ends));
  Diagnostics diagnostics;
  PrepareContext context{diagnostics, 0.01};
  body.prepare(context);
  hold.rest = body.q();
  body.connect(context);
  EXPECT_TRUE(diagnostics.ok()) << diagnostics.format();
  const int top = around * along / 2, bottom = top + around / 2;
  body.external[3 * top] = -1;
  body.external[3 * bottom] = 1;
  test::settle(body, 1);
  return 0.5 * (hold.rest[3 * top] - body.q()[3 * top] + body.q()[3 * bottom] - hold.rest[3 * bottom]) / 1.8248e-5;
}

TEST(PinchedCylinder, ConvergesToItsReferenceValue) {
  // The elements under a point load are too soft at first, so it is met from above.
  const double coarse = pinched(64, 32), fine = pinched(128, 64);
  EXPECT_GT(coarse, fine);
  EXPECT_LT(std::abs(fine - 1), 0.5 * std::abs(coarse - 1));
  EXPECT_TRUE(test::held("pinched cylinder, 128 x 64 cells", std::abs(fine - 1), 1, 0.06));
}

// A cantilever of two thicknesses, the tip's of length a: P / 3 (a^3 / (E I_tip) + (L^3 - a^3) / (E I_root)).
TEST(Bending, StepOfThicknessBendsAsItsParts) {
  const double length = 0.06, width = 0.01, thick = 3e-4, thin = 1.5e-4, young = 1e6;
  double last = 1;
  for (const int along : {12, 24, 48}) {
    const double cell = length / (along - 0.5);
    WallModel model;
    model.wall = test::plate(length + 0.5 * cell, width, along, 4, Cut::one_way);
    model.regions = {"root", "tip"};
    for (Vec3& x : model.wall.vertices) x.x() -= 0.5 * cell;
    const double border = (std::floor(0.5 * along) - 0.5) * cell;
    for (const Vec3& x : model.wall.vertices) model.vertex_region.push_back(x.x() > border + 0.1 * cell);
    ShellBody body;
    body.set_model(std::move(model));
    test::add_membrane(body, {.thickness = thick, .young = young, .poisson = 0, .regions = "root"});
    test::add_membrane(body, {.thickness = thin, .young = young, .poisson = 0, .regions = "tip"});
    ASSERT_EQ(test::finish(body, [&](const Vec3& x) { return x.x() < 0.6 * cell; }), "");
    const double force = 1e-9;
    double tip = 0;
    for (int i = 0; i < body.nodes(); ++i)
      if (body.rest_nodes()[std::size_t(i)].x() > length - 1e-9) {
        const double y = body.rest_nodes()[std::size_t(i)].y();
        body.external[3 * i + 2] = force * (y < 1e-9 || y > width - 1e-9 ? 0.125 : 0.25);
      }
    test::settle(body, 2);
    for (int i = 0; i < body.nodes(); ++i)
      if (body.rest_nodes()[std::size_t(i)].x() > length - 1e-9) tip += body.q()[3 * i + 2] / 5;
    // Column of cells past the border: half of its triangles are the root's.
    const double at = length - border - 0.5 * cell;
    const double i1 = width * std::pow(thick, 3) / 12, i2 = width * std::pow(thin, 3) / 12;
    const double expected = force / (3 * young) * (at * at * at / i2 + (std::pow(length, 3) - at * at * at) / i1);
    const double error = std::abs(tip / expected - 1);
    EXPECT_LT(error, 0.4 * last) << along;
    last = error;
  }
  EXPECT_TRUE(test::held("cantilever of two thicknesses", last, 1, 5e-4));
}

// Free vibration of a shaken tube: implicit Euler takes energy away and never adds any; momentum stays.
TEST(Membrane, EnergyIsBoundedInFreeVibration) {
  auto body = test::shell(test::cylinder(0.002, 0.008, 12, 10, Cut::shaken),
                          {.thickness = 2e-4, .young = 1e5, .poisson = 0.45});
  Random random(11);
  for (int i = 0; i < body->v().size(); ++i) body->v()[i] = 0.2 * random.uniform(-1, 1);
  const auto momentum = [&] {
    Vec3 sum = Vec3::Zero();
    for (int i = 0; i < body->nodes(); ++i) sum += body->node_mass()[std::size_t(i)] * body->v().segment<3>(3 * i);
    return sum;
  };
  const Vec3 before = momentum();
  const double start = body->energy();
  double most = 0;
  for (int n = 0; n < 300; ++n) {
    test::step(*body, 0.001);
    most = std::max(most, body->energy());
  }
  EXPECT_LT(most, start);
  EXPECT_TRUE(test::held("momentum of a wall that vibrates", (momentum() - before).norm(), before.norm(), 1e-10));
  EXPECT_EQ(body->indefinite_steps(), 0);
}

// A folded hinge comes back: angles past a half turn are told from those before it.
TEST(Membrane, AWallPressedThroughItselfUnfolds) {
  auto body =
      test::shell({{Vec3(0, 0, 0), Vec3(0, 1e-3, 0), Vec3(-1e-3, 5e-4, 0), Vec3(1e-3, 5e-4, 0), Vec3(-1e-3, 2e-3, 0)},
                   {{0, 1, 2}, {1, 0, 3}, {2, 1, 4}}},
                  {});
  VecX x = body->q();
  double last = -1;
  ForceModel& m = *body->forces()[0];
  for (int k = 0; k <= 70; ++k) {
    const double angle = 0.05 * k;  // to 3.5 rad, past the half turn
    x.segment<3>(9) = Vec3(1e-3 * std::cos(angle), 5e-4, 1e-3 * std::sin(angle));
    VecX f = VecX::Zero(x.size());
    m.linearise(x.data(), f.data(), nullptr, 0, Tangent::system);
    const double energy = m.energy(x.data());
    EXPECT_GT(energy, last) << angle;
    last = energy;
  }
  m.reset();
  EXPECT_LT(m.energy(x.data()), last);
}

}  // namespace
}  // namespace insula
