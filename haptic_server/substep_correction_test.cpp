// SPDX-License-Identifier: GPL-3.0-or-later
// Between steps: a viscoelastic layer against implicit Euler at 1 kHz, friction that turns round, tissue that goes on,
// force cross-fade.
#include "haptic_server/substep_correction.h"

#include <gtest/gtest.h>

#include <cmath>

#include "haptic_server/problem_for_test.h"
#include "haptic_server/servo.h"

namespace insula {
namespace {

constexpr double tick_s = 1e-3;

/// A layer of stiffness K and K beta v under a tool on a spring: u is how far it is pressed in, x the device, lambda
/// the contact.
///   step of h: K (1 + beta/h) du = lambda - K u,   gap = x + lambda / coupling + u
struct Layer {
  double stiffness = 60, beta = 0.02, coupling = 250;  // N/m, s, N/m
  double u = 0, rate = 0, lambda = 0;

  double compliance(double h) const { return 1 / (stiffness * (1 + beta / h)); }
  double free_gap(double h, double x) const { return x + u - stiffness * u * compliance(h); }
  void step(double h, double x) {
    const double w = compliance(h), free = free_gap(h, x);
    lambda = std::max(0.0, -free / (w + 1 / coupling));
    const double du = w * (lambda - stiffness * u);
    u += du;
    rate = du / h;
  }
};

/// What the engine would send after that step.
ConstraintProblem problem_of(const Layer& before, double h, double x) {
  Layer after = before;
  after.step(h, x);
  ConstraintProblem p;
  p.resize(1);
  p.step_s = h;
  p.w[0] = before.compliance(h) + 1 / before.coupling;
  p.delta_free[0] = before.free_gap(h, x);
  p.lambda[0] = after.lambda;
  p.rate[0] = after.rate;
  p.retardation_time[0] = before.beta;
  p.blocks.push_back({.id = 1, .lower = 0});
  ToolTerms t;
  t.hand = 1;
  t.device.p.z() = t.free.p.z() = x;
  t.stiffness.diagonal() << before.coupling, before.coupling, before.coupling, 1, 1, 1;
  t.compliance = t.stiffness.inverse();
  t.jacobian.setZero(1, 6);
  t.jacobian(0, 2) = 1;
  p.tools.push_back(t);
  return p;
}

ServoInput at(double x) {
  ServoInput in;
  in.device[1].p.z() = x;
  in.connected[1] = true;
  return in;
}

ServoSettings in_time() {
  ServoSettings s;
  s.substep = {.substep_compliance = true, .extrapolate_tissue = true, .incremental_slip = true};
  s.tolerance_m = 1e-15;
  s.max_sweeps = 1000;
  return s;
}

double press(double t) { return 1e-3 - 0.03 * t + 2e-3 * std::sin(40 * t); }

TEST(SubstepCorrection, ALayerAnswersAsInStepsOfItsOwnLength) {
  for (const double h : {0.01, 1.0 / 60, 1.0 / 30}) {
    for (const double start : {0.05, 0.09}) {  // in free air, pressed
      Layer engine;
      const int steps = int(start / h);
      for (int n = 0; n < steps; ++n) engine.step(h, press(n * h));
      const double now = steps * h;
      const ConstraintProblem p = problem_of(engine, h, press(now));
      engine.step(h, press(now));
      Servo servo(in_time());
      servo.set_problem(&p, {}, tick_s);
      double largest = 0;
      for (int k = 1; k <= 45; ++k) {
        const double x = press(now + k * tick_s);
        engine.step(tick_s, x);
        const ServoResult r = servo.tick(at(x));
        ASSERT_NEAR(r.hand[1].force.z(), engine.lambda, 1e-10) << h << " " << start << " " << k;
        largest = std::max(largest, engine.lambda);
      }
      EXPECT_GT(largest, 0.02);
    }
  }
}

TEST(SubstepCorrection, TheFirstTickCoversTheProblemsAge) {
  Layer engine;
  const double h = 1.0 / 60, late = 0.013;
  for (int n = 0; n < 6; ++n) engine.step(h, -1e-3);
  const ConstraintProblem p = problem_of(engine, h, -1.5e-3);
  engine.step(h, -1.5e-3);
  engine.step(late, -2e-3);
  Servo servo(in_time());
  servo.set_problem(&p, {}, late);
  EXPECT_NEAR(servo.tick(at(-2e-3)).hand[1].force.z(), engine.lambda, 1e-10);
}

TEST(SubstepCorrection, WithoutViscosityEquationSevenIsLeft) {
  ConstraintProblem p = testing::two_tool_problem(0, 40);
  testing::solve_as_engine(p);
  p.step_s = 1.0 / 60;
  ServoSettings plain = in_time();
  plain.substep = {};
  Servo a(plain), b(in_time());
  a.set_problem(&p);
  b.set_problem(&p);
  testing::Random random(5);
  ServoInput in;
  for (std::size_t i = 0; i < 2; ++i) {
    in.device[i] = p.tools[i].device;
    in.connected[i] = true;
  }
  for (int tick = 0; tick < 20; ++tick) {
    in.device[0].p += random.vector(2e-4);
    const ServoResult x = a.tick(in), y = b.tick(in);
    for (std::size_t i = 0; i < 2; ++i) EXPECT_NEAR((x.hand[i].force - y.hand[i].force).norm(), 0, 1e-8);
  }
}

TEST(SubstepCorrection, FrictionTurnsRoundWithTheHand) {
  // A contact that slid 2 mm in its step and is drawn back by 0.5 mm: since the step began it has still gone forward.
  ConstraintProblem p;
  p.resize(3);
  p.step_s = 1.0 / 60;
  for (int i = 0; i < 3; ++i) p.w[std::size_t(i * p.stride + i)] = 1e-3 + 1.0 / 250;
  p.delta_free = {-1e-3, 2e-3, 0};
  p.blocks.push_back({.id = 1, .law = LawKind::friction, .friction = 0.2});
  ToolTerms t;
  t.hand = 1;
  t.stiffness.diagonal() << 250, 250, 250, 1, 1, 1;
  t.compliance = t.stiffness.inverse();
  t.jacobian.setZero(3, 6);
  t.jacobian(0, 2) = t.jacobian(1, 0) = t.jacobian(2, 1) = 1;
  p.tools.push_back(t);
  testing::solve_as_engine(p);
  ServoSettings plain;
  Servo since_step(plain), by_tick(in_time());
  since_step.set_problem(&p);
  by_tick.set_problem(&p);
  Vec3 old, reversed;
  for (int k = 1; k <= 25; ++k) {
    ServoInput in = at(0);
    in.device[1].p.x() = -2e-5 * k;
    old = since_step.tick(in).hand[1].force;
    reversed = by_tick.tick(in).hand[1].force;
  }
  EXPECT_LT(old.x(), 0);
  EXPECT_GT(reversed.x(), 0);
  EXPECT_NEAR(std::abs(reversed.x()), 0.2 * reversed.z(), 1e-9);
}

TEST(SubstepCorrection, ARateThatLastsGoesOn) {
  // What nothing presses and moves by itself: the gap of a limit that grows.
  ConstraintProblem p;
  p.resize(1);
  p.step_s = 1.0 / 60;
  p.w[0] = 1.0 / 250;
  p.rate[0] = 0.3;
  p.retardation_time[0] = 10;
  p.blocks.push_back({.id = 1, .lower = 0});
  SubstepCorrection substep({.substep_compliance = true, .extrapolate_tissue = true}, 8);
  substep.begin(p, {}, tick_s);
  std::vector<double> none{0.0};
  double gap = 0;
  for (int k = 0; k < 10; ++k) {
    gap = substep.next(tick_s, {Vec6::Zero(), Vec6::Zero()}).delta_free[0];
    substep.solved(none, std::vector<double>{gap});
  }
  EXPECT_NEAR(gap, 10 * 0.3e-3, 1e-5);
}

TEST(SubstepCorrection, ANewProblemTakesOverWithoutAJump) {
  Layer engine;
  const double h = 1.0 / 30;
  for (int n = 0; n < 20; ++n) engine.step(h, -1e-3);
  const ConstraintProblem before = problem_of(engine, h, -1e-3);
  engine.stiffness *= 2;  // the step after has found something else
  const ConstraintProblem after = problem_of(engine, h, -1e-3);
  ServoSettings s = in_time();
  s.force_crossfade.within_s = 0.01;
  Servo smooth(s), abrupt(in_time());
  double last[2] = {0, 0}, jump[2] = {0, 0}, end[2] = {0, 0};
  for (int k = 0; k < 150; ++k) {
    int i = 0;
    for (Servo* servo : {&smooth, &abrupt}) {
      if (k == 0) servo->set_problem(&before, {}, tick_s);
      if (k == 33) servo->set_problem(&after, {}, tick_s);
      const double f = servo->tick(at(-1e-3)).hand[1].force.z();
      if (k > 0) jump[i] = std::max(jump[i], std::abs(f - last[i]));
      last[i] = end[i] = f;
      ++i;
    }
  }
  EXPECT_GT(jump[1], 4e-3);
  EXPECT_LT(jump[0], 0.2 * jump[1]);
  EXPECT_NEAR(end[0], end[1], 1e-12);  // and is forgotten
}

}  // namespace
}  // namespace insula
