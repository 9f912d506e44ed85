// SPDX-License-Identifier: GPL-3.0-or-later
// Elasticity against patch test, bar and beam theory, on structured meshes under refinement.
#include <gtest/gtest.h>

#include <cmath>

#include "core/base/random.h"
#include "core/testing/held.h"
#include "tests/figures/figure.h"
#include "tests/physics/soft_body_for_test.h"

namespace insula {
namespace {

using test::Material;

// A homogeneous deformation is in equilibrium on any mesh: with the boundary put there, the inside must follow.
TEST(PatchTest, AffineDeformationIsReproduced) {
  TetMesh mesh = test::block_mesh({4, 4, 4}, Vec3(-0.01, -0.02, 0), Vec3(0.02, 0.01, 0.03));
  const auto boundary = [](const Vec3& x) {
    const auto at = [](double v, double a, double b) { return std::abs(v - a) < 1e-9 || std::abs(v - b) < 1e-9; };
    return at(x.x(), -0.01, 0.02) || at(x.y(), -0.02, 0.01) || at(x.z(), 0, 0.03);
  };
  Random random(3);
  for (Vec3& x : mesh.nodes)
    if (!boundary(x)) x += 0.0015 * Vec3(random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-1, 1));
  for (const auto& [turn, strain] : {std::pair{0.0, 0.05}, std::pair{0.0, 0.2}, std::pair{2.0, 0.1}}) {
    auto body = test::soft_body(mesh, {.young = 2100, .poisson = 0.45}, boundary);
    Mat3 f;
    f << 1, 0.4, -0.3, -0.2, -0.5, 0.6, 0.1, 0.7, 0.3;
    f = from_rotation_vector(turn * Vec3(0.48, 0.6, -0.64)).toRotationMatrix() * (Mat3::Identity() + strain * f);
    const Vec3 shift(0.1, -0.2, 0.05);
    int inside = 0;
    for (int i = 0; i < body->nodes(); ++i) {
      Vec3 x = f * mesh.nodes[std::size_t(i)] + shift;
      if (!body->fixed()[std::size_t(i)]) {
        x += 0.001 * Vec3(random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-1, 1));
        ++inside;
      }
      body->q().segment<3>(3 * i) = x;
    }
    ASSERT_EQ(inside, 27);
    test::settle(*body, 60);
    for (int i = 0; i < body->nodes(); ++i)
      EXPECT_TRUE(test::held("patch test of a solid",
                             (body->q().segment<3>(3 * i) - (f * mesh.nodes[std::size_t(i)] + shift)).norm(), 0.03,
                             1e-10))
          << "node " << i << ", strain " << strain;
  }
}

constexpr double length = 0.1, width = 0.02, area = width * width;
TetMesh bar(int along, int across) {
  return test::block_mesh({along, across, across}, Vec3(0, -width / 2, -width / 2), Vec3(length, width / 2, width / 2));
}
bool clamped(const Vec3& x) { return x.x() < 1e-9; }
bool tip(const Vec3& x) { return x.x() > length - 1e-9; }

// Without Poisson's effect the clamped bar is homogeneous and the co-rotational law is linear in the stretch: exact.
TEST(Bar, EndLoadIsExact) {
  test::Figure figure("bar", "A bar pulled and pushed at its end: F x / (E A)", "place along the bar, mm",
                      "displacement, mm");
  for (const double force : {0.01, 0.1, -0.002}) {  // up to 25 % strain; pushed less than it takes to buckle
    const std::string pull = std::to_string(int(std::lround(force * 1000))) + " mN";
    for (const double x : {0.0, length}) figure.law(pull, x * 1e3, force * x / (1000 * area) * 1e3);
    auto body = test::soft_body(bar(6, 2), {.young = 1000, .poisson = 0, .tangent = "exact"}, clamped);
    test::load_face(*body, Vec3(force, 0, 0), tip);
    test::settle(*body, 30);
    for (int i = 0; i < body->nodes(); ++i) {
      const Vec3& x = body->rest().nodes[std::size_t(i)];
      const Vec3 expected = x + Vec3(force * x.x() / (1000 * area), 0, 0);
      EXPECT_LT((body->q().segment<3>(3 * i) - expected).norm(), 1e-10 * length);
      if (std::abs(x.y()) + std::abs(x.z()) < 1e-9) figure.run(pull, x.x() * 1e3, (body->q()[3 * i] - x.x()) * 1e3);
    }
  }
}

// Under its own weight: tip displacement rho g L^2 / (2 E).
TEST(Bar, OwnWeightConverges) {
  const double young = 1e5, g = 9.81;
  const double expected = 1000 * g * length * length / (2 * young);
  double last = 0;
  test::Figure figure("own_weight", "A bar under its own weight, rho g L^2 / (2 E), under refinement", "cubes across",
                      "lengthening over theory");
  for (const int n : {1, 2, 4}) {
    auto body = test::soft_body(bar(5 * n, n), {.young = young, .poisson = 0}, clamped);
    for (int k = 0; k < 20; ++k) {
      body->v().setZero();
      test::step(*body, 1e6, Vec3(g, 0, 0));
    }
    const double ratio = test::mean_displacement(*body, tip).x() / expected, error = std::abs(ratio - 1);
    figure.run("lengthening", n, ratio);
    figure.law("theory", n, 1);
    if (n > 1) {
      EXPECT_LT(error, 0.35 * last) << n;
    }
    last = error;
  }
  EXPECT_LT(last, 1e-3);
}

// A clamped bar with Poisson's effect: away from the clamp it stretches as bar theory says.
TEST(Bar, PoissonContractionConverges) {
  const double young = 1e5, nu = 0.3, force = 0.2, stress = force / area;
  double last = 1;
  for (const int n : {2, 4}) {
    auto body = test::soft_body(bar(5 * n, n), {.young = young, .poisson = nu}, clamped);
    test::load_face(*body, Vec3(force, 0, 0), tip);
    test::settle(*body, 20);
    const auto section = [](double at) { return [at](const Vec3& x) { return std::abs(x.x() - at) < 1e-9; }; };
    const double stretch =
        (test::mean_displacement(*body, section(0.8 * length)) - test::mean_displacement(*body, section(0.4 * length)))
            .x() /
        (0.4 * length);
    const auto side = [](double y) {
      return [y](const Vec3& x) { return std::abs(x.x() - 0.6 * length) < 1e-9 && std::abs(x.y() - y) < 1e-9; };
    };
    const double across =
        (test::mean_displacement(*body, side(width / 2)) - test::mean_displacement(*body, side(-width / 2))).y() /
        width;
    const double error = std::max(std::abs(stretch * young / stress - 1), std::abs(across * young / (nu * stress) + 1));
    EXPECT_LT(error, last);
    last = error;
  }
  EXPECT_TRUE(test::held("stretch and contraction of a bar", last, 1, 5e-3));
}

// Tip deflection of a cantilever: P L^3 / (3 E I) + P L / (k G A), k = 5/6 for a square without Poisson's effect
// (Cowper 1966). Linear tetrahedra are too stiff by O(size^2): the error falls by four and the extrapolation is right.
TEST(Cantilever, ConvergesToBeamTheory) {
  const double young = 1e6, load = 1e-4, inertia = width * width * width * width / 12;
  const double expected =
      load * length * length * length / (3 * young * inertia) + load * length / (5.0 / 6 * young / 2 * area);
  std::vector<double> ratio;
  test::Figure figure("cantilever", "A cantilever under refinement: P L^3/(3 E I) + P L/(k G A)",
                      "tetrahedra's cubes across the height", "deflection over beam theory");
  for (const int n : {2, 4, 8}) {
    auto body = test::soft_body(bar(5 * n, n), {.young = young, .poisson = 0}, clamped);
    test::load_face(*body, Vec3(0, 0, -load), tip);
    test::settle(*body, 2);
    ratio.push_back(-test::mean_displacement(*body, tip).z() / expected);
    figure.run("deflection", n, ratio.back());
    figure.law("beam theory", n, 1);
  }
  EXPECT_LT(ratio[0], ratio[1]);
  EXPECT_LT(ratio[1], ratio[2]);
  EXPECT_GT((1 - ratio[1]) / (1 - ratio[2]), 3.0) << "not of second order";
  EXPECT_LT(1 - ratio[2], 0.06);
  const double extrapolated = ratio[2] + (ratio[2] - ratio[1]) / 3;
  EXPECT_NEAR(extrapolated, 1, 0.01) << ratio[0] << " " << ratio[1] << " " << ratio[2];
}

// The whole deflected beam turned: the same deflection in the turned frame (the element frames follow).
TEST(Cantilever, IsFrameIndifferent) {
  auto straight = test::soft_body(bar(10, 2), {.young = 1e4, .poisson = 0.3, .tangent = "exact"}, clamped);
  TetMesh mesh = bar(10, 2);
  const Quat turn = from_rotation_vector(Vec3(0.7, -1.2, 0.4));
  for (Vec3& x : mesh.nodes) x = turn * x;
  auto turned = test::soft_body(mesh, {.young = 1e4, .poisson = 0.3, .tangent = "exact"},
                                [&](const Vec3& x) { return clamped(turn.conjugate() * x); });
  test::load_face(*straight, Vec3(0, 0, -0.012), tip);
  test::load_face(*turned, turn * Vec3(0, 0, -0.012), [&](const Vec3& x) { return tip(turn.conjugate() * x); });
  test::settle(*straight, 60);
  test::settle(*turned, 60);
  EXPECT_GT(std::abs(test::mean_displacement(*straight, tip).z()), 0.1 * length) << "the deflection is not large";
  for (int i = 0; i < straight->nodes(); ++i)
    EXPECT_TRUE(test::held("large deflection, turned as a whole",
                           (turned->q().segment<3>(3 * i) - turn * straight->q().segment<3>(3 * i)).norm(), length,
                           1e-9))
        << i;
}

}  // namespace
}  // namespace insula
