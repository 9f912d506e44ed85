// SPDX-License-Identifier: GPL-3.0-or-later
// A problem in other directions is the same problem; a tool past an edge feels what lies beyond it.
#include "core/haptics/contact_frame_prediction.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "haptic_server/problem_for_test.h"
#include "plugins/contact/contact_for_test.h"

namespace insula {
namespace {

MatX w_of(const ConstraintProblem& p) {
  MatX w(p.rows, p.rows);
  for (int i = 0; i < p.rows; ++i)
    for (int j = 0; j < p.rows; ++j) w(i, j) = p.w_at(i, j);
  return w;
}

VecX vector_of(const std::vector<double>& v, int rows) { return Eigen::Map<const VecX>(v.data(), rows); }

TEST(ContactFramePrediction, ForcesMotionsAndWorkAreTheSameInOtherDirections) {
  ConstraintProblem p = testing::two_tool_problem(6, 8, 2);
  testing::solve_as_engine(p);
  const ConstraintProblem old = p;
  const VecX lambda = vector_of(p.lambda, p.rows), delta = w_of(p) * lambda + vector_of(p.delta_free, p.rows);
  std::vector<double> delta_m(delta.data(), delta.data() + p.rows);
  testing::Random random(4);
  MatX all = MatX::Identity(p.rows, p.rows);
  for (const int row : {0, 6, 15}) {
    const Mat3 q = from_rotation_vector(random.vector(1)).toRotationMatrix();
    rotate_contact_rows(p, row, q, delta_m);
    all.block<3, 3>(row, row) = q;
  }
  const VecX now = vector_of(p.lambda, p.rows);
  EXPECT_LT((now - all * lambda).norm(), 1e-14);
  EXPECT_LT((vector_of(delta_m, p.rows) - all * delta).norm(), 1e-16);
  EXPECT_LT((w_of(p) - all * w_of(old) * all.transpose()).norm(), 1e-15);
  for (std::size_t t = 0; t < 2; ++t)
    EXPECT_LT((p.tools[t].jacobian.transpose() * now - old.tools[t].jacobian.transpose() * lambda).norm(), 1e-14);
}

// Friction knows no direction in the plane of its contact: with other tangents the solution is the same force.
TEST(ContactFramePrediction, OtherTangentsChangeNoForce) {
  ConstraintProblem p = testing::two_tool_problem(6, 8, 3);
  testing::solve_as_engine(p);
  const ConstraintProblem old = p;
  std::vector<double> delta_m(std::size_t(p.rows), 0.0);
  for (int row = 0; row < 18; row += 3) {
    const Mat3 q =
        from_rotation_vector((0.3 + row) * Vec3::UnitX()).toRotationMatrix();  // rows are normal, tangent, tangent
    rotate_contact_rows(p, row, q, delta_m);
    const Vec3 free = q * Eigen::Map<const Vec3>(p.delta_free.data() + row);
    for (int k = 0; k < 3; ++k) p.delta_free[std::size_t(row + k)] = free[k];
  }
  std::fill(p.lambda.begin(), p.lambda.end(), 0.0);
  testing::solve_as_engine(p);
  for (std::size_t t = 0; t < 2; ++t) {
    const Vec6 was = old.tools[t].jacobian.transpose() * vector_of(old.lambda, p.rows);
    EXPECT_GT(was.norm(), 0.01);
    EXPECT_LT((p.tools[t].jacobian.transpose() * vector_of(p.lambda, p.rows) - was).norm(), 1e-8);
  }
}

/// The largest turn that blocks tell while a ball is led about the edge of a plate by `degrees` a step.
double max_rotation_about_an_edge(double degrees) {
  using namespace test;
  constexpr double pressed = 0.05e-3;
  const Vec3 edge(0.05, 0.003, 0);
  Bench b(test_tool_urdf(radius), ground(), upright, R"(friction="1e-9" linearized_at="end")");
  if (!b.tool) return -1;
  ContactFramePrediction predict;
  double most = 0;
  for (int i = -4; i < 4; ++i) {
    const double angle = (80 - std::max(0, i) * degrees) * std::numbers::pi / 180;
    b.move_to({edge + (radius - pressed) * Vec3(std::cos(angle), 0, std::sin(angle)), b.tool->home_pose().q});
    for (const Block& block : predict(*b.s, b.s->problem(), 0.5 * b.s->h()).blocks)
      if (i >= 2)
        most = std::max(most, std::hypot(double(block.frame_rotation[0]), double(block.frame_rotation[1]),
                                         double(block.frame_rotation[2])));
  }
  return most;
}

TEST(ContactFramePrediction, BlocksTellHowFarTheyTurnNextUnlessItIsOverAnEdge) {
  EXPECT_NEAR(max_rotation_about_an_edge(8), 8 * std::numbers::pi / 180, 0.01);
  EXPECT_EQ(max_rotation_about_an_edge(16), 0);
}

}  // namespace
}  // namespace insula
