// SPDX-License-Identifier: GPL-3.0-or-later
// Rotation of blocks, and the solution of the rotated problem.
#include "core/haptics/contact_frame_prediction.h"

#include <algorithm>

#include "core/constraint/sweep.h"

namespace insula {
namespace {

constexpr double min_turn = 1e-6;
constexpr double max_later =
    0.2;  // rad in a step; more is an edge of the surface, which the tool passes at an unknown time

/// The new directions in terms of the old ones: normal and tangents are rotated together by the smallest rotation.
Mat3 rotation(const Vec3& normal, const Vec3& tangent, const Vec3& to) {
  const Mat3 turn = Quat::FromTwoVectors(normal, to).toRotationMatrix();
  Mat3 old;
  old << normal.transpose(), tangent.transpose(), normal.cross(tangent).transpose();
  return old * turn.transpose() * old.transpose();
}

/// Rotation vector in the form of a block.
std::array<float, 3> rotation_vector(const Vec3& from, const Vec3& to) {
  const Eigen::AngleAxisd turn(Quat::FromTwoVectors(from, to));
  if (turn.angle() > max_later) return {};
  const Vec3 v = turn.angle() * turn.axis();
  return {float(v[0]), float(v[1]), float(v[2])};
}

template <class Problem>
auto block_at(Problem& p, int row) {
  return std::lower_bound(p.blocks.begin(), p.blocks.end(), row,
                          [](const Block& b, int first) { return b.row < first; });
}

/// Whether the frame is one of a friction block of the problem.
bool is_of(const ConstraintProblem& p, const ContactFrame& f) {
  const auto block = block_at(p, f.row);
  return block != p.blocks.end() && block->row == f.row && block->law == LawKind::friction && f.ahead.allFinite() &&
         f.later.allFinite();
}

bool is_replaced(const ConstraintProblem& p, int row) {
  return std::any_of(p.patches.replaced.begin(), p.patches.replaced.end(),
                     [&](const ReplacedContact& r) { return r.row == row; });
}

}  // namespace

void rotate_contact_rows(ConstraintProblem& p, int row, const Mat3& q, std::span<double> delta_m) {
  const std::size_t n = std::size_t(p.rows), stride = std::size_t(p.stride), r = std::size_t(row);
  const auto turn = [&](double* at, std::size_t by) {
    const Vec3 v = q * Vec3(at[0], at[by], at[2 * by]);
    for (std::size_t k = 0; k < 3; ++k) at[k * by] = v[long(k)];
  };
  for (std::size_t j = 0; j < n; ++j) turn(&p.w[r * stride + j], stride);
  for (std::size_t i = 0; i < n; ++i) turn(&p.w[i * stride + r], 1);
  for (ToolTerms& tool : p.tools)
    for (long c = 0; c < 6; ++c) turn(tool.jacobian.data() + 6 * row + c, 6);
  const std::size_t modes = p.reduced.modes.size();
  for (std::size_t s = 0; s < modes; ++s) turn(p.reduced.row(r) + s, modes);
  for (double* v : {delta_m.data(), p.lambda.data(), p.rate.data()}) turn(v + r, 1);
}

const ConstraintProblem& ContactFramePrediction::operator()(const Simulation& simulation,
                                                            const ConstraintProblem& problem, double ahead_s) {
  const double steps = ahead_s / simulation.h();
  frames_.clear();
  for (const Constraint* c : simulation.constraints()) c->predict_frames(steps, frames_);
  std::erase_if(frames_, [&](const ContactFrame& f) { return !is_of(problem, f) || is_replaced(problem, f.row); });
  if (frames_.empty()) return problem;
  predicted_ = problem;
  ConstraintProblem& p = predicted_;
  p.prediction_horizon_steps = steps;
  for (const ContactFrame& f : frames_) block_at(p, f.row)->frame_rotation = rotation_vector(f.ahead, f.later);
  std::erase_if(frames_, [](const ContactFrame& f) { return f.normal.cross(f.ahead).norm() < min_turn; });
  if (frames_.empty()) return p;
  const std::size_t n = std::size_t(p.rows);
  full_delta(p, {p.delta_free.data(), n}, p.lambda.data(), delta_m_);
  for (const ContactFrame& f : frames_) {
    const double gap = delta_m_[std::size_t(f.row)];
    rotate_contact_rows(p, f.row, rotation(f.normal, f.tangent, f.ahead), delta_m_);
    delta_m_[std::size_t(f.row)] = gap;  // a pressing contact keeps its gap
  }
  p.reduced.limit(0, n, [&](std::size_t i) { return p.w_at(int(i), int(i)); });
  work_.assign(std::size_t(p.stride), 0.0);
  sweep_kernels().combine(work_.data(), p.w.data(), p.stride, p.lambda.data(), p.rows, p.stride);
  for (std::size_t i = 0; i < n; ++i) p.delta_free[i] = delta_m_[i] - work_[i];
  workspace_.reserve(p.rows);
  workspace_.lambda.assign(p.lambda.begin(), p.lambda.begin() + p.rows);
  solve(p, p.delta_free, simulation.solve_settings(), workspace_);
  p.lambda.assign(workspace_.lambda.begin(), workspace_.lambda.end());
  return predicted_;
}

}  // namespace insula
