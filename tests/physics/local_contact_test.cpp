// SPDX-License-Identifier: GPL-3.0-or-later
// The exact solution of one contact with friction against a search over directions.
#include "core/constraint/friction.h"
#include "core/testing/held.h"
#include "tests/physics/random_problem.h"

namespace insula {
namespace {

using namespace test;

LocalContact local(const Mat3& w, const Vec3& q) {
  return {w(0, 0), w(0, 1), w(0, 2), w(1, 1), w(1, 2), w(2, 2), q[0], q[1], q[2]};
}

// All sliding solutions by search over the direction of friction: gap closed and slip against it.
std::vector<Vec3> search(const Mat3& w, const Vec3& q, double mu) {
  std::vector<Vec3> found;
  if (q[0] >= 0) return {Vec3::Zero()};
  const Vec3 stick = -w.ldlt().solve(q);
  if (stick[0] >= 0 && stick.tail<2>().norm() <= mu * stick[0]) found.push_back(stick);
  struct Slide {
    Vec3 lambda, delta;
    double across, along;
  };
  const auto at = [&](double angle) {
    const Eigen::Vector2d d(std::cos(angle), std::sin(angle));
    const double reduced = w(0, 0) + mu * (w(0, 1) * d[0] + w(0, 2) * d[1]);
    Slide s;
    const double n = -q[0] / reduced;
    s.lambda = Vec3(n, mu * n * d[0], mu * n * d[1]);
    s.delta = w * s.lambda + q;
    s.across = s.delta[1] * d[1] - s.delta[2] * d[0];
    s.along = s.delta[1] * d[0] + s.delta[2] * d[1];
    return s;
  };
  const int n = 4000;
  const double step = 2 * 3.14159265358979323846 / n;
  Slide before = at(0);
  for (int i = 1; i <= n; ++i) {
    const Slide now = at(i * step);
    if ((before.across > 0) != (now.across > 0) && before.lambda[0] > 0 && now.lambda[0] > 0) {
      double low = (i - 1) * step, high = i * step;
      for (int k = 0; k < 60; ++k) {
        const double middle = 0.5 * (low + high);
        ((at(middle).across > 0) == (before.across > 0) ? low : high) = middle;
      }
      const Slide s = at(0.5 * (low + high));
      if (s.along < 0 && std::abs(s.across) < 1e-9 * (s.delta.norm() + q.norm())) found.push_back(s.lambda);
    }
    before = now;
  }
  return found;
}

TEST(LocalContact, IsTheSolutionThatASearchFinds) {
  Random random(1);
  int stick = 0, slide = 0, open = 0, several = 0;
  for (int trial = 0; trial < 5000; ++trial) {
    const MatX a = random_matrix(random, 3, 5);
    const Mat3 w = a * a.transpose() + 0.02 * Mat3::Identity();
    const Vec3 q(random.uniform(-1, 0.3), random.uniform(-1, 1), random.uniform(-1, 1));
    const double mu = trial % 10 == 0 ? 0.0 : random.uniform(0.02, 1.0);
    Vec3 lambda;
    solve_contact(local(w, q), mu, lambda.data());
    const Vec3 delta = w * lambda + q;
    const double force = q.norm() / w.trace(), length = q.norm();
    ASSERT_LT(contact_error(delta, lambda, mu, length, std::max(force, lambda.norm())), 1e-8)
        << "trial " << trial << " mu " << mu << " lambda " << lambda.transpose() << " delta " << delta.transpose();
    if (mu == 0) continue;
    const auto all = search(w, q, mu);
    ASSERT_FALSE(all.empty()) << trial;
    double nearest = 1e300;
    for (const Vec3& s : all) nearest = std::min(nearest, (s - lambda).norm());
    EXPECT_TRUE(test::held("contact with friction = search", nearest, std::max(force, lambda.norm()), 1e-7))
        << "trial " << trial << ": " << all.size() << " found by search";
    several += all.size() > 1;
    if (q[0] >= 0) ++open;
    else if (delta.tail<2>().norm() < 1e-9) ++stick;
    else ++slide;
  }
  EXPECT_GT(stick, 200);
  EXPECT_GT(slide, 1000);
  EXPECT_GT(open, 200);
}

TEST(LocalContact, DegenerateInputsGiveFiniteForces) {
  const Vec3 q(-1, 0.5, 0.2);
  for (const double mu : {0.0, 0.3, 5.0})
    for (const Mat3& w : {Mat3(Mat3::Zero()), Mat3(Vec3(1, 0, 0).asDiagonal()), Mat3(Mat3::Ones()),
                          Mat3(1e-12 * Mat3::Identity()), Mat3(Vec3(1, 1e-14, 1).asDiagonal())}) {
      Vec3 lambda;
      solve_contact(local(w, q), mu, lambda.data());
      EXPECT_TRUE(lambda.allFinite());
      EXPECT_GE(lambda[0], 0);
      EXPECT_LE(lambda.tail<2>().norm(), mu * lambda[0] * (1 + 1e-12));
    }
}

}  // namespace
}  // namespace insula
