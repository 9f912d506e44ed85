// SPDX-License-Identifier: GPL-3.0-or-later
// Implicit Euler against the closed form of the discretised law: fall, momentum, rigid motion, damping, oscillation.
#include <gtest/gtest.h>

#include <cmath>

#include "core/base/random.h"
#include "core/testing/held.h"
#include "tests/figures/figure.h"
#include "tests/physics/soft_body_for_test.h"

namespace insula {
namespace {

TetMesh cube() { return test::block_mesh({3, 3, 3}, Vec3(0.1, -0.2, 0.3), Vec3(0.12, -0.18, 0.32)); }

Vec3 momentum(const SoftBody& b) {
  Vec3 p = Vec3::Zero();
  for (int i = 0; i < b.nodes(); ++i) p += b.node_mass()[std::size_t(i)] * b.v().segment<3>(3 * i);
  return p;
}

Vec3 angular_momentum(const SoftBody& b) {
  Vec3 c = Vec3::Zero(), l = Vec3::Zero();
  double m = 0;
  for (int i = 0; i < b.nodes(); ++i) {
    c += b.node_mass()[std::size_t(i)] * b.q().segment<3>(3 * i);
    m += b.node_mass()[std::size_t(i)];
  }
  c /= m;
  for (int i = 0; i < b.nodes(); ++i)
    l += b.node_mass()[std::size_t(i)] * Vec3(b.q().segment<3>(3 * i) - c).cross(Vec3(b.v().segment<3>(3 * i)));
  return l;
}

// v_n = n h g, x_n = x_0 + h^2 g n (n + 1) / 2: exact for the discretised law.
TEST(ImplicitEuler, FreeFall) {
  auto body = test::soft_body(cube(), {.young = 2100, .poisson = 0.45, .rayleigh_stiffness = 0.02});
  const Vec3 g(0.5, -1, -9.81);
  const double h = 1.0 / 60;
  test::Figure figure("fall", "A body that falls: h^2 g n (n + 1) / 2 after n steps", "step of 1/60 s", "fallen, m");
  for (int n = 1; n <= 100; ++n) {
    test::step(*body, h, g);
    figure.law("law", n, -0.5 * h * h * n * (n + 1) * g.z());
    if (n % 4 == 0) figure.run("run", n, body->rest().nodes[0].z() - body->q()[2]);
    for (int i = 0; i < body->nodes(); ++i) {
      ASSERT_LT((body->v().segment<3>(3 * i) - n * h * g).norm(), 1e-9 * n * h * g.norm()) << "step " << n;
      ASSERT_LT(
          (body->q().segment<3>(3 * i) - body->rest().nodes[std::size_t(i)] - 0.5 * h * h * n * (n + 1) * g).norm(),
          1e-9 * h * h * n * (n + 1) * g.norm());
    }
  }
}

TEST(ImplicitEuler, RigidTranslationAndSmallRotationStayRigid) {
  const double h = 0.01;
  const Vec3 v(0.3, -0.2, 0.7), spin = 1e-6 * Vec3(0.6, -0.64, 0.48);
  for (const bool turning : {false, true}) {
    auto body = test::soft_body(cube(), {.young = 2100, .poisson = 0.45});
    Vec3 centre = Vec3::Zero();
    for (const Vec3& x : body->rest().nodes) centre += x / body->nodes();
    const auto velocity = [&](int i) -> Vec3 {
      return turning ? Vec3(spin.cross(body->rest().nodes[std::size_t(i)] - centre)) : v;
    };
    for (int i = 0; i < body->nodes(); ++i) body->v().segment<3>(3 * i) = velocity(i);
    for (int n = 1; n <= 100; ++n) {
      test::step(*body, h);
      for (int i = 0; i < body->nodes(); ++i) {
        const Vec3 moved = body->q().segment<3>(3 * i) - body->rest().nodes[std::size_t(i)];
        ASSERT_TRUE(test::held("rigid motion stays rigid", (moved - n * h * velocity(i)).norm(),
                               turning ? 0.02 : n * h * v.norm(), 1e-10))
            << "step " << n;
        // Rotation by 1e-6 rad: also right to that size relative to itself (its square is the next order).
        if (turning) {
          ASSERT_LT((moved - n * h * velocity(i)).norm(), 2e-6 * n * h * spin.norm() * 0.02);
        }
      }
    }
  }
}

TEST(ImplicitEuler, FreeBodyKeepsItsMomentum) {
  std::vector<double> drift;
  for (const double h : {0.002, 0.001}) {
    auto body = test::soft_body(cube(), {.young = 2100, .poisson = 0.45, .rayleigh_stiffness = 0.005});
    Random random(9);
    double size = 0;
    for (int i = 0; i < body->nodes(); ++i) {
      const Vec3 r = body->rest().nodes[std::size_t(i)] - Vec3(0.11, -0.19, 0.31);
      body->q().segment<3>(3 * i) += 0.1 * Vec3(r.y(), -r.x() + r.z(), r.x()) +
                                     0.0002 * Vec3(random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-1, 1));
      body->v().segment<3>(3 * i) = Vec3(0.1, -0.3, 0.2) + Vec3(3, -2, 4).cross(r);
      size += body->node_mass()[std::size_t(i)] * body->v().segment<3>(3 * i).norm();
    }
    const Vec3 p = momentum(*body), l = angular_momentum(*body);
    for (int n = 0; n < int(std::lround(0.2 / h)); ++n) {
      test::step(*body, h);
      ASSERT_TRUE(test::held("momentum of a free body", (momentum(*body) - p).norm(), size, 1e-11)) << "step " << n;
    }
    drift.push_back((angular_momentum(*body) - l).norm() / l.norm());
  }
  // The rotated tangent resists the spin of a strained element a little, whatever the step: a turn of 1.1 rad at 10 %
  // strain may cost half a per cent of the angular momentum.
  EXPECT_LT(drift[0], 0.005);
  EXPECT_LT(drift[1], 0.005);
}

// Mass damping alone: p_n = p_0 / (1 + alpha h)^n.
TEST(RayleighDamping, MassPartSlowsRigidMotion) {
  const double alpha = 7, h = 1.0 / 60;
  auto body = test::soft_body(cube(), {.young = 2100, .poisson = 0.3, .rayleigh_mass = alpha});
  const Vec3 v(0.1, 0.2, -0.4);
  for (int i = 0; i < body->nodes(); ++i) body->v().segment<3>(3 * i) = v;
  double factor = 1;
  test::Figure figure("mass_damping", "A body slowed by the damping of its mass: 1 / (1 + alpha h)^n", "step",
                      "speed over that at first");
  for (int n = 1; n <= 120; ++n) {
    test::step(*body, h);
    factor /= 1 + alpha * h;
    figure.law("law", n, factor);
    if (n % 4 == 0) figure.run("run", n, body->v()[2] / v.z());
    for (int i = 0; i < body->nodes(); ++i)
      ASSERT_LT((body->v().segment<3>(3 * i) - factor * v).norm(), 1e-10 * v.norm()) << n;
  }
}

// One tetrahedron on three fixed nodes, its apex moved along the height: an undistorted frame, so the spring is exactly
// linear, k = V (2 mu + lambda) / a^2, and the step is a scalar recursion:
//   (m/h^2 + alpha m/h + (1 + beta/h) k) dq = -k u + m v/h
TEST(RayleighDamping, OscillatorFollowsTheDiscretisedLaw) {
  const double a = 0.01, young = 2100, nu = 0.45, density = 1000;
  const double mu = young / (2 * (1 + nu)), lambda = young * nu / ((1 + nu) * (1 - 2 * nu));
  const double volume = a * a * a / 6, k = volume * (2 * mu + lambda) / (a * a), m = density * volume / 4;
  test::Figure figure("oscillator", "A mass on tissue in implicit Euler", "step", "displacement, mm");
  for (const auto& [alpha, beta, h] : {std::tuple{0.0, 0.0, 1e-4}, std::tuple{0.0, 0.0, 1.0 / 60},
                                       std::tuple{1.0, 0.02, 1.0 / 60}, std::tuple{50.0, 0.0, 1e-3}}) {
    auto body = test::soft_body(test::single_tet(a), {young, nu, density, alpha, beta},
                                [](const Vec3& x) { return x.z() < 1e-9; });
    double u = 0.2 * a, v = -0.3;
    body->q()[11] += u;
    body->v()[11] = v;
    double most = 0, energy = 0.5 * m * v * v + 0.5 * k * u * u;
    EXPECT_NEAR(body->energy(), energy, 1e-12 * energy);
    for (int n = 1; n <= 300; ++n) {
      test::step(*body, h);
      const double dq = (-k * u + m * v / h) / (m / (h * h) + alpha * m / h + (1 + beta / h) * k);
      u += dq;
      v = dq / h;
      most = std::max(most, std::abs(u));
      ASSERT_NEAR(body->q()[11] - a, u, 1e-9 * most) << "step " << n;
      if (h < 1e-3 || alpha > 10) {
        const std::string curve = h < 1e-3 ? "undamped, h = 0.1 ms" : "damped, h = 1 ms";
        figure.law(curve, n, u * 1e3);
        if (n % 4 == 0) figure.run(curve, n, (body->q()[11] - a) * 1e3);
      }
      ASSERT_LT(std::abs(body->q()[9]) + std::abs(body->q()[10]), 1e-12 * a);
      energy = 0.5 * m * v * v + 0.5 * k * u * u;
      ASSERT_NEAR(body->energy(), energy, 1e-9 * (0.5 * m * 0.09 + 0.5 * k * most * most));
    }
  }
}

// The rows' compliance is that of the body's own system matrix: a unit force through a row moves its point by W.
TEST(ImplicitEuler, ComplianceAndCorrectionAgree) {
  auto body = test::soft_body(cube(), {.young = 2100, .poisson = 0.45, .rayleigh_mass = 1, .rayleigh_stiffness = 0.02},
                              [](const Vec3& x) { return x.z() < 0.3 + 1e-9; });
  body->q() = [&] {
    VecX q = body->q();
    for (int i = 0; i < body->nodes(); ++i)
      if (!body->fixed()[std::size_t(i)]) q[3 * i] += 0.1 * (q[3 * i + 2] - 0.3);
    return q;
  }();
  const VecX start = body->q();
  StepContext context;
  Random random(4);
  const int rows = 12;
  body->rows.clear();
  std::vector<MaterialPoint> points;
  std::vector<Vec3> directions;
  for (int r = 0; r < rows; ++r) {
    MaterialPoint p;
    p.body = body.get();
    p.count = 3;
    for (std::size_t k = 0; k < 3; ++k) p.node[k] = int(random.below(std::uint32_t(body->nodes())));
    p.weight = {0.2, 0.3, 0.5, 0};
    const Vec3 d = Vec3(random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-1, 1)).normalized();
    body->rows.open(r);
    body->add_row(body->rows, p, d);
    points.push_back(p);
    directions.push_back(d);
  }
  body->free_motion(context);
  body->begin_compliance(body->rows);
  body->solver()->compute_parts();
  const int stride = 16;
  std::vector<double> w(std::size_t(rows * stride), 0.0);
  std::vector<double> free(rows, 0.0), lambda(rows);
  body->add_response(body->rows, w.data(), stride, free.data());
  for (int r = 0; r < rows; ++r) {
    lambda[std::size_t(r)] = random.uniform(-0.01, 0.01);
  }
  body->apply(context, body->rows, lambda.data());
  for (int r = 0; r < rows; ++r) {
    double expected = free[std::size_t(r)];
    for (int c = 0; c < rows; ++c) {
      expected += w[std::size_t(r * stride + c)] * lambda[std::size_t(c)];
      EXPECT_EQ(w[std::size_t(r * stride + c)], w[std::size_t(c * stride + r)]);
    }
    double moved = 0;
    for (int k = 0; k < 3; ++k) {
      const int n = points[std::size_t(r)].node[std::size_t(k)];
      moved += points[std::size_t(r)].weight[std::size_t(k)] *
               directions[std::size_t(r)].dot(body->q().segment<3>(3 * n) - start.segment<3>(3 * n));
    }
    EXPECT_TRUE(test::held("unit lambda moves its point by W", std::abs(moved - expected), 1, 1e-12)) << r;
  }
}

}  // namespace
}  // namespace insula
