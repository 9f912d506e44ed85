// SPDX-License-Identifier: GPL-3.0-or-later
// The reduced model with all modes kept against implicit Euler at 1 kHz, its closed forms, its limits, its energy.
#include "haptic_server/reduced_dynamics.h"

#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <cmath>

#include "haptic_server/patched_problem_for_test.h"
#include "haptic_server/problem_for_test.h"
#include "haptic_server/servo.h"

namespace insula {
namespace {

constexpr double tick_s = 1e-3;
using Matrix = Eigen::MatrixXd;

ServoSettings exact(bool dynamics = true) {
  ServoSettings s;
  s.substep = {.substep_compliance = true,
               .extrapolate_tissue = true,
               .incremental_slip = true,
               .find_contacts = true,
               .reduced_dynamics = dynamics};
  s.tolerance_m = 1e-15;
  s.max_sweeps = 2000;
  s.max_operations = 1e9;
  return s;
}

/// Linear tissue of some masses, M v' + (alpha M + beta K) v + K u = H^T lambda, under two tools on springs that press
/// on it: x is the device, gap = x + lambda / coupling + H u.
struct Tissue {
  static constexpr long dofs = 9, rows = 2;
  VecX mass = VecX::Zero(dofs), u = VecX::Zero(dofs), v = VecX::Zero(dofs), before = VecX::Zero(dofs);
  Matrix k, h_rows;
  double alpha = 3, beta = 0.02, coupling = 250;  // 1/s, s, N/m
  VecX lambda = VecX::Zero(rows);

  explicit Tissue(std::uint64_t seed, double mass_kg = 4e-3) {
    testing::Random random(seed);
    Matrix a(dofs, dofs);
    for (double& x : a.reshaped()) x = random.next();
    k = 20 * (a * a.transpose()) + 20 * Matrix::Identity(dofs, dofs);
    h_rows.resize(rows, dofs);
    for (double& x : h_rows.reshaped()) x = 0.4 * random.next();
    for (double& m : mass) m = mass_kg * (1.2 + random.next());
  }
  Matrix system(double h) const { return inertia() / (h * h) + damping() / h + k; }
  Matrix inertia() const { return mass.asDiagonal(); }
  Matrix damping() const { return alpha * inertia() + beta * k; }
  Matrix compliance(double h) const { return h_rows * system(h).ldlt().solve(h_rows.transpose()); }
  VecX free_gap(double h, const VecX& x) const {
    return x + h_rows * (u + system(h).ldlt().solve(VecX(mass.cwiseProduct(v) / h - k * u)));
  }
  ConstraintProblem contact(double h, const VecX& x) const {
    ConstraintProblem p;
    p.resize(rows);
    p.step_s = h;
    testing::set_w(p, Matrix(compliance(h) + Matrix::Identity(rows, rows) / coupling));
    const VecX free = free_gap(h, x);
    for (int i = 0; i < rows; ++i) {
      p.delta_free[std::size_t(i)] = free[i];
      p.retardation_time[std::size_t(i)] = beta;
      p.blocks.push_back({.id = std::uint64_t(i + 1), .row = i, .lower = 0});
      ToolTerms t;
      t.hand = i;
      t.device.p.z() = t.free.p.z() = x[i];
      t.stiffness.diagonal() << coupling, coupling, coupling, 1, 1, 1;
      t.compliance = t.stiffness.inverse();
      t.jacobian.setZero(rows, 6);
      t.jacobian(i, 2) = 1;
      p.tools.push_back(t);
    }
    testing::solve_as_engine(p);
    return p;
  }
  void step(double h, const VecX& x) {
    const ConstraintProblem p = contact(h, x);
    lambda = Eigen::Map<const VecX>(p.lambda.data(), rows);
    before = v;
    v = system(h).ldlt().solve(VecX(mass.cwiseProduct(v) / h - k * u + h_rows.transpose() * lambda)) / h;
    u += h * v;
  }
};

/// The problem of a step, with all modes of the tissue.
ConstraintProblem problem_of(const Tissue& before, double h, const VecX& x) {
  ConstraintProblem p = before.contact(h, x);
  Tissue after = before;
  after.step(h, x);
  const Eigen::GeneralizedSelfAdjointEigenSolver<Matrix> modes(before.inertia(), before.system(h));
  const Matrix& v = modes.eigenvectors();  // V^T A V = 1
  const Matrix damping = v.transpose() * before.damping() * v, participation = before.h_rows * v;
  const VecX velocity = v.transpose() * before.system(h) * after.v,
             force = v.transpose() * (before.inertia() * (after.v - before.v) / h + before.damping() * after.v),
             rate = before.h_rows * after.v;
  std::vector<ReducedModel::Mode> found;
  for (long s = 0; s < Tissue::dofs; ++s)
    found.push_back({modes.eigenvalues()[s], damping(s, s), velocity[s], force[s]});
  p.reduced.add_group(found, Tissue::rows);
  for (long i = 0; i < Tissue::rows; ++i) {
    p.rate[std::size_t(i)] = rate[i];
    for (long s = 0; s < Tissue::dofs; ++s) p.reduced.row(std::size_t(i))[s] = participation(i, s);
  }
  return p;
}

ServoInput at(const VecX& x) {
  ServoInput in;
  for (std::size_t i = 0; i < 2; ++i) {
    in.device[i].p.z() = x[long(i)];
    in.connected[i] = true;
  }
  return in;
}

VecX press(double t) {
  VecX x(2);
  x << 1e-3 - 0.06 * t + 2e-3 * std::sin(60 * t), 0.5e-3 - 0.04 * t + 1.5e-3 * std::sin(90 * t + 1);
  return x;
}

TEST(ReducedDynamics, WithAllModesTheServoIsTheEngineAtOneKilohertz) {
  for (const double h : {1.0 / 240, 1.0 / 60, 1.0 / 30})
    for (const double start : {0.04, 0.07}) {
      Tissue engine(7);
      const int steps = int(start / h);
      for (int n = 0; n < steps; ++n) engine.step(h, press(n * h));
      const double now = steps * h;
      const ConstraintProblem p = problem_of(engine, h, press(now));
      engine.step(h, press(now));
      Servo servo(exact()), without(exact(false));
      servo.set_problem(&p, {}, tick_s);
      without.set_problem(&p, {}, tick_s);
      double largest = 0, error_without = 0;
      bool apart = false;
      for (int k = 1; k <= 60; ++k) {
        const VecX x = press(now + k * tick_s);
        engine.step(tick_s, x);
        const ServoResult r = servo.tick(at(x)), other = without.tick(at(x));
        for (std::size_t i = 0; i < 2; ++i) {
          const double truth = engine.lambda[long(i)];
          ASSERT_NEAR(r.hand[i].force.z(), truth, 1e-9) << h << " " << start << " " << k;
          largest = std::max(largest, truth);
          error_without = std::max(error_without, std::abs(other.hand[i].force.z() - truth));
          apart = apart || truth == 0;
        }
      }
      EXPECT_GT(largest, 0.02);
      EXPECT_TRUE(apart) << "a contact is lost";
      EXPECT_GT(error_without, 1e-3) << "inertia matters here";
    }
}

TEST(ReducedDynamics, MomentumIsThatOfTheForces) {
  // Free tissue: K 1 = 0 and no damping by mass. Its momentum 1^T M v grows by the force times the tick.
  const double h = 1.0 / 60;
  Tissue body(3);
  body.alpha = 0;
  const VecX ones = VecX::Ones(Tissue::dofs);
  const Matrix rest = Matrix::Identity(Tissue::dofs, Tissue::dofs) - ones * ones.transpose() / double(Tissue::dofs);
  body.k = rest * body.k * rest;
  const ConstraintProblem p = problem_of(body, h, VecX::Constant(2, 1.0));  // nothing touches, at rest
  const Eigen::GeneralizedSelfAdjointEigenSolver<Matrix> modes(body.inertia(), body.system(h));
  const VecX weight = modes.eigenvectors().transpose() * body.mass;  // 1^T M V
  ReducedDynamics dynamics;
  dynamics.begin(&p.reduced, h);
  dynamics.set_tick(tick_s);
  double momentum = 0, impulse = 0;
  for (int k = 0; k < 50; ++k) {
    const double force = 0.01 * std::cos(0.3 * k);
    dynamics.clear_force();
    dynamics.add_force(p.reduced.row(0), force);
    impulse += force * body.h_rows.row(0).sum() * tick_s;
    dynamics.advance();
    momentum = dynamics.rate(weight.data());
    EXPECT_NEAR(momentum, impulse, 1e-12);
  }
  EXPECT_GT(std::abs(impulse), 1e-6);
}

/// One mode whose row is the displacement of a mass m on k and c.
ReducedModel one_mode(double m, double c, double k, double h, double velocity) {
  const double g = 1 / std::sqrt(m / (h * h) + c / h + k);  // V^T A V = 1
  ReducedModel model;
  model.add_group({{m * g * g, c * g * g, velocity / g, c * velocity * g}}, 1);
  *model.row(0) = g;
  return model;
}

TEST(ReducedDynamics, AModeIsADampedOscillator) {
  // Let go of with a speed, at rest before: x = v0/w e^(-zeta t) sin(w t). Implicit Euler is of first order.
  const double m = 2e-3, c = 0.02, k = 40, v0 = 0.05, end = 0.05;
  const double zeta = c / (2 * m), w = std::sqrt(k / m - zeta * zeta);
  const double truth = v0 / w * std::exp(-zeta * end) * std::sin(w * end);
  ReducedModel model = one_mode(m, c, k, 1.0 / 60, v0);
  model.modes[0].force = 0;
  std::vector<double> error;
  for (const int ticks : {50, 100, 200, 400}) {
    ReducedDynamics dynamics;
    dynamics.begin(&model, 1.0 / 60);
    dynamics.set_tick(end / ticks);
    double x = 0;
    for (int n = 0; n < ticks; ++n) {
      dynamics.advance();
      x += dynamics.displacement(model.row(0));
    }
    error.push_back(std::abs(x - truth));
  }
  for (std::size_t n = 1; n < error.size(); ++n) EXPECT_NEAR(error[n - 1] / error[n], 2, 0.25);
  EXPECT_LT(error.back(), 0.05 * v0 / w);
}

TEST(ReducedDynamics, WithoutMassItIsTheViscousCorrection) {
  for (const double age : {tick_s, 0.013}) {
    const double h = 1.0 / 60, beta = 0.02, stiffness = 60;
    Tissue tissue(5);
    tissue.mass.setConstant(1e-12);
    tissue.alpha = 0;
    tissue.beta = beta;
    tissue.k *= stiffness / 60;
    for (int n = 0; n < 4; ++n) tissue.step(h, press(0.03 + n * h));
    const ConstraintProblem p = problem_of(tissue, h, press(0.1));
    Servo with(exact()), without(exact(false));
    with.set_problem(&p, {}, age);
    without.set_problem(&p, {}, age);
    double largest = 0;
    for (int k = 1; k <= 40; ++k) {
      const ServoInput in = at(press(0.1 + age + k * tick_s));
      const ServoResult a = with.tick(in), b = without.tick(in);
      for (std::size_t i = 0; i < 2; ++i) {
        EXPECT_NEAR(a.hand[i].force.z(), b.hand[i].force.z(), 1e-7) << k;
        largest = std::max(largest, a.hand[i].force.z());
      }
    }
    EXPECT_GT(largest, 0.02);
  }
}

TEST(ReducedDynamics, EnergyNeverGrowsByItself) {
  testing::Random random(11);
  const double h = 1.0 / 60;
  ReducedModel model;
  std::vector<ReducedModel::Mode> modes;
  for (int s = 0; s < 20; ++s) {
    const double inertia = 0.5 + 0.5 * random.next(), damping = (1 - inertia) * (0.5 + 0.5 * random.next());
    modes.push_back({inertia * h * h, damping * h, random.next(), 0});
  }
  model.add_group(modes, 1);
  for (int s = 0; s < 20; ++s) model.row(0)[s] = random.next();
  ReducedDynamics dynamics;
  dynamics.begin(&model, h);
  double energy = dynamics.energy();
  ASSERT_GT(energy, 0);
  for (int k = 0; k < 400; ++k) {
    dynamics.set_tick(1e-4 * std::exp2(5 * random.next()));
    // Some ticks are pushed. The push does work, which bounds the growth.
    const double force = k % 3 == 0 ? 1e-2 * random.next() : 0;
    dynamics.clear_force();
    dynamics.add_force(model.row(0), force);
    dynamics.advance();
    EXPECT_LE(dynamics.energy(), energy + force * dynamics.displacement(model.row(0)) + 1e-15) << k;
    energy = dynamics.energy();
  }
}

TEST(ReducedDynamics, AMessageThatIsRoundedStaysPassive) {
  // Stiffness 1 - m/h^2 - c/h that rounding makes negative counts as none.
  const double h = 1.0 / 60;
  ReducedModel model;
  model.add_group({{h * h * (1 + 1e-7), 1e-9, 1e-3, 0}}, 1);
  *model.row(0) = 1;
  ReducedDynamics dynamics;
  dynamics.begin(&model, h);
  dynamics.set_tick(tick_s);
  const double first = dynamics.energy();
  for (int k = 0; k < 1000; ++k) dynamics.advance();
  EXPECT_LE(dynamics.energy(), first);
}

/// The triangle of patched_problem_for_test.h with a mass at each corner, and all of its nine modes.
ConstraintProblem heavy_triangle(const Vec3& centre, double h, bool as_rows, double load) {
  const testing::SoftVertex vertex;
  const double mass = 0.02;
  // Less elasticity gives the same compliance over the step, so W stays as it is.
  const double whole = 1 / vertex.compliance(h), inertia = mass / (h * h);
  const double elastic = (whole - inertia) / (1 + vertex.beta / h), g = 1 / std::sqrt(whole);
  ConstraintProblem p = testing::soft_triangle(vertex, centre, h, 0.3, as_rows, load);
  p.reduced.add_group(std::vector<ReducedModel::Mode>(9, {mass / whole, vertex.beta * elastic / whole, 0, 0}),
                      std::size_t(p.rows));
  const Vec3 axes[3] = {Vec3::UnitZ(), Vec3::UnitX(), Vec3::UnitY()};
  for (std::size_t corner = 0; corner < 3; ++corner)
    for (std::size_t a = 0; a < 3; ++a) {
      for (std::size_t row = 0; row < 3; ++row) p.reduced.row(row)[3 * corner + a] = -axes[row][long(a)] * g / 3;
      if (!as_rows) p.reduced.row(3 + 3 * corner + a)[3 * corner + a] = g;
    }
  return p;
}

TEST(ReducedDynamics, AContactOnAPatchHasTheInertiaOfItsRows) {
  const double h = 1.0 / 60;
  const Vec3 centre(0, 0, testing::patched_radius_m);
  for (const double load : {0.0, 0.01}) {
    const ConstraintProblem rows = heavy_triangle(centre, h, true, load),
                            patch = heavy_triangle(centre, h, false, load);
    Servo by_rows(exact()), by_patch(exact()), massless(exact(false));
    by_rows.set_problem(&rows, {}, 3e-3);
    by_patch.set_problem(&patch, {}, 3e-3);
    massless.set_problem(&patch, {}, 3e-3);
    double difference = 0;
    for (int k = 1; k < 40; ++k) {
      ServoInput in;
      in.connected[1] = true;
      in.device[1].p = centre - Vec3(0, 0, 5e-5 * k);
      const Vec3 a = by_rows.tick(in).hand[1].force, b = by_patch.tick(in).hand[1].force;
      EXPECT_NEAR((a - b).norm(), 0, 1e-9) << "tick " << k << ", " << a.transpose() << " and " << b.transpose();
      EXPECT_GT(a.z(), 0.01);
      difference = std::max(difference, (massless.tick(in).hand[1].force - b).norm());
    }
    EXPECT_GT(difference, 1e-3) << "inertia matters here";
  }
}

}  // namespace
}  // namespace insula
