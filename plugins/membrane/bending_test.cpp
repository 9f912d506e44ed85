// SPDX-License-Identifier: GPL-3.0-or-later
// Bending of a wall: exact for quadratics on any mesh, beams and plates under refinement, large rotation, curved at
// rest.
#include <gtest/gtest.h>

#include <cmath>
#include <numeric>

#include "core/testing/held.h"
#include "plugins/membrane/shell_for_test.h"
#include "tests/figures/figure.h"

namespace insula {
namespace {

using test::Cut;
using test::Wall;
constexpr Cut every_cut[] = {Cut::one_way, Cut::criss_cross, Cut::shaken};

void draw(test::Figure& figure, Cut cut, const std::vector<std::pair<double, double>>& ratios) {
  for (const auto& [cells, ratio] : ratios) {
    figure.law("theory", cells, 1);
    figure.run(cut == Cut::one_way ? "one way" : cut == Cut::shaken ? "shaken" : "criss-cross", cells, ratio);
  }
}

// A quadratic deflection has constant moments, so it is in equilibrium inside whatever the mesh; all nodes near the
// rim, where slopes have fewer hinges to come from, are put there.
TEST(Bending, QuadraticDeflectionIsReproducedOnAnyMesh) {
  const double size = 0.03, tiny = 1e-5;
  for (const Cut cut : every_cut)
    for (const Mat3& curvature : {Mat3{{1, 0, 0}, {0, 0, 0}, {0, 0, 0}}, Mat3{{0, 1, 0}, {1, 0, 0}, {0, 0, 0}},
                                  Mat3{{0.3, -0.7, 0}, {-0.7, 1.1, 0}, {0, 0, 0}}}) {
      const auto rim = [&](const Vec3& x) {
        return std::min({x.x(), x.y(), size - x.x(), size - x.y()}) < 3.5 * size / 12;
      };
      auto body = test::shell(test::plate(size, size, 12, 12, cut), {}, rim);
      const auto place = [&](int i) -> Vec3 {
        const Vec3 x = body->rest_nodes()[std::size_t(i)], r = x - Vec3(0.5 * size, 0.5 * size, 0);
        return x + Vec3(0, 0, tiny / size * 0.5 * r.dot(curvature * r));
      };
      int inside = 0;
      for (int i = 0; i < body->nodes(); ++i) {
        body->q().segment<3>(3 * i) = place(i);
        if (body->fixed()[std::size_t(i)]) continue;
        body->q()[3 * i + 2] = 0;
        ++inside;
      }
      ASSERT_GE(inside, 25);
      test::settle(*body, 10);
      for (int i = 0; i < body->nodes(); ++i)
        EXPECT_TRUE(
            test::held("bending patch test", (body->q().segment<3>(3 * i) - place(i)).norm(), tiny * size, 1e-7))
            << "node " << i << ", cut " << int(cut);
    }
}

// Fixed nodes keep a triangle's plane, which is the slope at its middle: the clamp lies in the middle of the held cell.
double strip_ratio(int along, int across, Cut cut) {
  const double length = 0.05, width = 0.01, cell = length / (along - 0.5);
  const Wall w{.thickness = 2e-4, .young = 1e6, .poisson = 0};
  TriMesh mesh = test::plate(length + 0.5 * cell, width, along, across, cut);
  for (Vec3& x : mesh.vertices) {
    x.x() -= 0.5 * cell;
    if (std::abs(x.x() - 0.5 * cell) < 0.3 * cell) x.x() = 0.5 * cell;  // the held cell stays straight
  }
  auto body = test::shell(std::move(mesh), w, [&](const Vec3& x) { return x.x() < 0.6 * cell; });
  const double inertia = width * std::pow(w.thickness, 3) / 12, force = 1e-9;
  double sum = 0, tip = 0;
  for (int i = 0; i < body->nodes(); ++i) {
    const Vec3& x = body->rest_nodes()[std::size_t(i)];
    if (x.x() < length - 1e-9) continue;
    const double part = (x.y() < 1e-9 || x.y() > width - 1e-9 ? 0.5 : 1.0) / across;
    body->external[3 * i + 2] = part * force;
    sum += part;
  }
  EXPECT_NEAR(sum, 1, 1e-12);
  test::settle(*body, 2);
  for (int i = 0; i < body->nodes(); ++i)
    if (body->rest_nodes()[std::size_t(i)].x() > length - 1e-9) tip += body->q()[3 * i + 2] / (across + 1);
  return tip / (force * std::pow(length, 3) / (3 * w.young * inertia));
}

TEST(Bending, CantileverConvergesToEulerBernoulli) {
  test::Figure figure("strip", "A strip of wall as a cantilever, P L^3 / (3 E I), under refinement", "cells along",
                      "deflection over beam theory");
  for (const Cut cut : every_cut) {
    const double coarse = strip_ratio(10, 2, cut), middle = strip_ratio(20, 4, cut), fine = strip_ratio(40, 8, cut);
    draw(figure, cut, {{10, coarse}, {20, middle}, {40, fine}});
    EXPECT_GT((1 - coarse) / (1 - middle), 3.5) << "not of second order, cut " << int(cut);
    EXPECT_GT((1 - middle) / (1 - fine), 3.5) << "not of second order, cut " << int(cut);
    EXPECT_NEAR(fine, 1, 3e-4) << "cut " << int(cut);
  }
}

/// Mean deflection of a simply supported square plate under even load, over Navier's series.
double plate_ratio(int n, Cut cut) {
  const double a = 0.04;
  const Wall w{.thickness = 2e-4, .young = 1e6, .poisson = 0.3};
  auto body = test::shell(test::plate(a, a, n, n, cut), w, [&](const Vec3& x) {
    return std::min({x.x(), x.y(), a - x.x(), a - x.y()}) < 1e-9;
  });
  const double d = w.young * std::pow(w.thickness, 3) / (12 * (1 - w.poisson * w.poisson)), p = 1e-7;
  double mean = 0, series = 0;
  std::vector<double> area(std::size_t(body->nodes()), 0.0);
  for (const auto& t : body->wall_triangles()) {
    const auto at = [&](int k) { return body->rest_nodes()[std::size_t(t[std::size_t(k)])]; };
    for (int v : t) area[std::size_t(v)] += (at(1) - at(0)).cross(at(2) - at(0)).norm() / 6;
  }
  for (int i = 0; i < body->nodes(); ++i) body->external[3 * i + 2] = p * area[std::size_t(i)];
  test::settle(*body, 2);
  for (int i = 0; i < body->nodes(); ++i) mean += body->q()[3 * i + 2] * area[std::size_t(i)] / (a * a);
  for (int i = 1; i < 60; i += 2)
    for (int j = 1; j < 60; j += 2)
      series += 64 / (std::pow(std::numbers::pi, 8) * i * i * j * j * std::pow(i * i + j * j, 2));
  return mean / (series * p * std::pow(a, 4) / d);
}

TEST(Bending, PlateConvergesOnAnyMesh) {
  test::Figure figure("plate", "A simply supported plate, Navier's series, under refinement", "cells along a side",
                      "deflection over Navier's");
  for (const Cut cut : every_cut) {
    const double coarse = plate_ratio(8, cut), middle = plate_ratio(16, cut), fine = plate_ratio(32, cut);
    draw(figure, cut, {{8, coarse}, {16, middle}, {32, fine}});
    EXPECT_LT(std::abs(middle - 1), 0.4 * std::abs(coarse - 1)) << "cut " << int(cut);
    EXPECT_LT(std::abs(fine - 1), 0.4 * std::abs(middle - 1)) << "cut " << int(cut);
    EXPECT_NEAR(fine, 1, 5e-4) << "cut " << int(cut);
  }
}

// Large deflection of a cantilever (Bisshopp, Drucker 1945): P L^2 / (E I) = 1 and 10.
/// The elastica: a cantilever whose end hangs at the angle `slope` under a load across it (Bisshopp, Drucker 1945,
/// equations 8 to 12).
struct Elastica {
  double load, down, back;  ///< P L^2 / (E I); of the end, in lengths
  explicit Elastica(double slope) {
    const double k = std::sqrt(0.5 * (1 + std::sin(slope))), from = std::asin(1 / (k * std::numbers::sqrt2));
    const double root = std::comp_ellint_1(k) - std::ellint_1(k, from);
    load = root * root;
    down = 1 - 2 * (std::comp_ellint_2(k) - std::ellint_2(k, from)) / root;
    back = 1 - std::sqrt(2 * std::sin(slope)) / root;
  }
  static Elastica under(double load) {
    double low = 1e-4, high = 1.57;
    while (high - low > 1e-14) (Elastica(0.5 * (low + high)).load < load ? low : high) = 0.5 * (low + high);
    return Elastica(low);
  }
};

TEST(Bending, ElasticaAtLargeRotation) {
  test::Figure figure("elastica", "A strip under a load at its end: the elastica", "P L^2 / (E I)",
                      "displacement of the end over the length");
  for (double load = 0.1; load <= 10.05; load += 0.1)
    figure.law("down", load, Elastica::under(load).down), figure.law("back", load, Elastica::under(load).back);
  const double length = 0.05, width = 0.005;
  const int along = 40;
  const double cell = length / (along - 0.5);
  const Wall w{.thickness = 1e-4, .young = 1e6, .poisson = 0};
  for (const auto& [load, down, back] : {std::array{1.0, 0.30172, 0.05643}, std::array{10.0, 0.81061, 0.55500}}) {
    EXPECT_NEAR(Elastica::under(load).down, down, 1e-5);
    EXPECT_NEAR(Elastica::under(load).back, back, 1e-5);
    TriMesh mesh = test::plate(length + 0.5 * cell, width, along, 4, Cut::one_way);
    for (Vec3& x : mesh.vertices) x.x() -= 0.5 * cell;
    auto body = test::shell(std::move(mesh), w, [&](const Vec3& x) { return x.x() < 0.6 * cell; });
    const double force = load * w.young * width * std::pow(w.thickness, 3) / 12 / (length * length);
    const auto tip = [&](int i) { return body->rest_nodes()[std::size_t(i)].x() > length - 1e-9; };
    for (int s = 1; s <= 10; ++s) {
      for (int i = 0; i < body->nodes(); ++i)
        if (tip(i)) {
          const double y = body->rest_nodes()[std::size_t(i)].y();
          body->external[3 * i + 2] = s / 10.0 * force * (y < 1e-9 || y > width - 1e-9 ? 0.125 : 0.25);
        }
      for (int k = 0; k < 60; ++k) test::step(*body, 0.5);
      Vec3 moved = Vec3::Zero();
      for (int i = 0; i < body->nodes(); ++i)
        if (tip(i)) moved += (body->q().segment<3>(3 * i) - body->rest_nodes()[std::size_t(i)]) / 5;
      const double now = s / 10.0 * load;
      const Elastica law = Elastica::under(now);
      EXPECT_NEAR(moved.z() / length, law.down, 5e-4) << now;
      EXPECT_NEAR(-moved.x() / length, law.back, 5e-4) << now;
      if (load > 1 || s == 5) figure.run("down", now, moved.z() / length), figure.run("back", now, -moved.x() / length);
    }
  }
}

// Quarter circle, clamped, with a load at its end along the radius there (Castigliano): pi/4 and 1/2 of P R^3 / (E I).
TEST(Bending, StripCurvedAtRest) {
  const double radius = 0.02, width = 0.005;
  const Wall w{.thickness = 1e-4, .young = 1e6, .poisson = 0};
  test::Figure figure("curved_strip", "A quarter circle at rest, bent (Castigliano), under refinement", "cells along",
                      "movement over Castigliano's");
  for (const Cut cut : every_cut) {
    double last = 1;
    for (const int n : {8, 16, 32}) {
      const int across = std::max(2, n / 4);
      auto mesh = test::sheet(n, across, cut, [&](double u, double v) {
        const double angle = 0.5 * std::numbers::pi * (n * u - 0.5) / (n - 0.5);
        return Vec3(radius * std::sin(angle), width * v, radius * (1 - std::cos(angle)));
      });
      auto body = test::shell(std::move(mesh), w,
                              [&](const Vec3& x) { return x.x() < 1.4 * radius / n && x.z() < 0.5 * radius; });
      const double force = 1e-10,
                   unit = force * std::pow(radius, 3) * 12 / (w.young * width * std::pow(w.thickness, 3));
      const auto tip = [&](int i) { return body->rest_nodes()[std::size_t(i)].z() > radius - 1e-9; };
      for (int i = 0; i < body->nodes(); ++i)
        if (tip(i)) {
          const double y = body->rest_nodes()[std::size_t(i)].y();
          body->external[3 * i] = force * (y < 1e-9 || y > width - 1e-9 ? 0.5 : 1) / across;
        }
      test::settle(*body, 2);
      Vec3 moved = Vec3::Zero();
      for (int i = 0; i < body->nodes(); ++i)
        if (tip(i)) moved += (body->q().segment<3>(3 * i) - body->rest_nodes()[std::size_t(i)]) / (across + 1);
      const double error =
          std::max(std::abs(moved.x() / unit / (std::numbers::pi / 4) - 1), std::abs(moved.z() / unit / -0.5 - 1));
      EXPECT_LT(error, 0.4 * last) << "cut " << int(cut) << ", " << n;
      draw(figure, cut, {{double(n), moved.x() / unit / (std::numbers::pi / 4)}});
      last = error;
    }
    // Nodes off the rulings make the flat triangles stretch when they should only bend; that falls with their size too.
    EXPECT_LT(last, cut == Cut::shaken ? 0.03 : 4e-4) << "cut " << int(cut);
  }
}

// The step's stiffness of single hinges against that of whole patches: never less than half of it, and not wildly more.
TEST(Bending, HingesBoundThePatches) {
  for (const test::Cut cut : {test::Cut::one_way, test::Cut::criss_cross, test::Cut::shaken}) {
    auto body = test::shell(test::plate(0.01, 0.01, 8, 8, cut), {});
    ForceModel& model = *body->forces().front();
    const std::vector<int> all = [&] {
      std::vector<int> n(std::size_t(body->nodes()));
      std::iota(n.begin(), n.end(), 0);
      return n;
    }();
    const auto product = [&](const char* tangent, const VecX& d) {
      model.find_param("tangent")->assign(tangent, {});
      std::vector<std::pair<int, int>> pairs;
      model.couplings(pairs, Tangent::system);
      BlockMatrix a;
      a.set_pattern(body->nodes(), std::move(pairs));
      model.bind(a, all);
      VecX f = VecX::Zero(d.size()), y = VecX::Zero(d.size());
      model.linearise(body->q().data(), f.data(), &a, 0, Tangent::system);
      a.add_product(d.data(), y.data());
      return d.dot(y);
    };
    Random random(3);
    for (int trial = 0; trial < 40; ++trial) {
      VecX d = VecX::Zero(3 * body->nodes());
      // Deflections of the flat plate: bending alone; from smooth to rough.
      for (int i = 0; i < body->nodes(); ++i) {
        const Vec3 x = body->rest_nodes()[std::size_t(i)];
        d[3 * i + 2] =
            trial < 20 ? std::sin(300 * trial * x.x()) * std::cos(200 * trial * x.y() + trial) : random.uniform(-1, 1);
      }
      const double patches = product("patches", d), hinges = product("hinges", d);
      EXPECT_GE(hinges, 0.5 * patches);
      EXPECT_LE(hinges, 40 * patches + 1e-12);
    }
  }
}

}  // namespace
}  // namespace insula
