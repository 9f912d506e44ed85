// SPDX-License-Identifier: GPL-3.0-or-later
// Elimination of the rows between a tool and the body that it grasps.
#include "core/haptics/weld_elimination.h"

#include <Eigen/Cholesky>
#include <Eigen/LU>
#include <algorithm>
#include <cmath>

#include "core/constraint/problem_fields.h"

namespace insula {
namespace {

constexpr double nothing = 1e-6;  // of a row's compliance, since W is in single precision

std::size_t tools_of(const ConstraintProblem& p) { return std::min<std::size_t>(p.tools.size(), 2); }

/// W of the rows by the tools alone.
double w_tools(const ConstraintProblem& p, int i, int j) {
  double sum = 0;
  for (std::size_t t = 0; t < tools_of(p); ++t)
    for (int a = 0; a < 6; ++a) {
      const double left = p.tools[t].jacobian(i, a);
      if (left == 0) continue;
      for (int b = 0; b < 6; ++b) sum += left * p.tools[t].compliance(a, b) * p.tools[t].jacobian(j, b);
    }
  return sum;
}

bool touches(const ToolTerms& t, int row) {
  for (int c = 0; c < 6; ++c)
    if (t.jacobian(row, c) != 0) return true;
  return false;
}

bool ties(const ConstraintProblem& p, std::size_t tool, const Block& b) {
  if (b.role != BlockRole::weld || b.law != LawKind::box || b.lower != -infinite || b.upper != infinite ||
      b.compliance != 0)
    return false;
  if (p.retardation_time[std::size_t(b.row)] != 0) return false;  // tissue
  for (std::size_t t = 0; t < tools_of(p); ++t)
    if (touches(p.tools[t], b.row) != (t == tool)) return false;
  return true;
}

Mat6 rows_of(const ToolTerms& t, int first) {
  Mat6 out;
  for (int r = 0; r < 6; ++r)
    for (int c = 0; c < 6; ++c) out(r, c) = t.jacobian(first + r, c);
  return out;
}

// Disables a row between the tool and the body that it grasps. It cannot move any more, and its force is internal.
void silence(ConstraintProblem& p, std::size_t tool, int row) {
  const std::size_t stride = std::size_t(p.stride), r = std::size_t(row);
  for (std::size_t i = 0; i < std::size_t(p.rows); ++i) p.w[i * stride + r] = p.w[r * stride + i] = 0;
  p.w[r * stride + r] = 1;
  p.delta_free[r] = p.lambda[r] = p.rate[r] = 0;
  p.tools[tool].jacobian.row(row).setZero();
}

}  // namespace

int first_weld_row(const ConstraintProblem& p, std::size_t tool) {
  int count = 0;
  for (std::size_t b = 0; b < p.blocks.size(); ++b) {
    if (!ties(p, tool, p.blocks[b])) count = 0;
    else count = count > 0 && p.blocks[b].owner != p.blocks[b - 1].owner ? 1 : count + 1;
    if (count == weld_rows) return p.blocks[b].row - weld_rows + 1;
  }
  return -1;
}

WeldElimination::WeldElimination(int max_rows) {
  for (auto* rows : {&body_, &tool_, &both_}) rows->assign(std::size_t(max_rows), Vec6::Zero());
  for (ConstraintProblem& p : reduced_) {
    p.resize(max_rows);
    p.reduced.reserve(std::size_t(max_rows));
    p.blocks.reserve(std::size_t(max_rows));
    p.tools.resize(2);
    for (ToolTerms& t : p.tools) t.jacobian.setZero(max_rows, 6);
  }
}

const ConstraintProblem& WeldElimination::eliminate(const ConstraintProblem& problem) noexcept {
  grasped_ = {};
  const ConstraintProblem* last = &problem;
  for (std::size_t t = 0; t < tools_of(problem); ++t) {
    const int first = first_weld_row(*last, t);
    if (first >= 0 && reduce(*last, t, first, reduced_[t])) last = &reduced_[t];
  }
  return *last;
}

// Copies everything except the six rows. Jacobians have room for the largest number of rows.
void WeldElimination::copy_rest(const ConstraintProblem& from, int first, ConstraintProblem& to) noexcept {
  to.resize(from.rows - weld_rows);  // within its capacity
  copy_scalars(from, to);
  to.reduced.take_modes(from.reduced, std::size_t(to.rows));
  to.blocks.clear();
  for (Block b : from.blocks) {
    if (b.row >= first && b.row < first + weld_rows) continue;
    if (b.row > first) b.row -= weld_rows;
    to.blocks.push_back(b);
  }
  const std::size_t had = to.tools.size(), now = tools_of(from);
  if (now < had) spare_.swap(to.tools[1].jacobian);
  to.tools.resize(now);
  if (now > had) spare_.swap(to.tools[1].jacobian);
  for (std::size_t t = 0; t < now; ++t) {
    const ToolTerms& a = from.tools[t];
    ToolTerms& b = to.tools[t];
    b.coupling() = a;
    for (int i = 0; i < to.rows; ++i) b.jacobian.row(i) = a.jacobian.row(i < first ? i : i + weld_rows);
  }
  for (int i = 0; i < to.rows; ++i) copy_row(from, std::size_t(i < first ? i : i + weld_rows), to, std::size_t(i));
}

bool WeldElimination::reduce(const ConstraintProblem& from, std::size_t tool, int first,
                             ConstraintProblem& to) noexcept {
  const ToolTerms& t = from.tools[tool];
  const double h = from.step_s;
  const Mat6 h_joint = rows_of(t, first);
  Mat6 clip_joint;
  for (int a = 0; a < 6; ++a)
    for (int b = 0; b < 6; ++b)
      clip_joint(a, b) = from.w_at(first + a, first + b) - w_tools(from, first + a, first + b);
  const Eigen::LLT<Mat6> factor(clip_joint);
  const Eigen::PartialPivLU<Mat6> kinematics(h_joint);
  if (!(h > 0) || factor.info() != Eigen::Success || !(std::abs(kinematics.determinant()) > 0)) return false;
  const Mat6 p = factor.solve(Mat6::Identity());
  const Mat6 a = t.compliance.inverse();
  const Mat6 give = (a + h_joint.transpose() * p * h_joint).inverse();
  if (!give.allFinite() || !p.allFinite()) return false;

  copy_rest(from, first, to);
  const int n = to.rows;
  Vec6 rate_joint, push = Vec6::Zero(), push_now = Vec6::Zero();
  for (int k = 0; k < 6; ++k) rate_joint[k] = from.rate[std::size_t(first + k)];
  for (int i = 0; i < from.rows; ++i) push += from.lambda[std::size_t(i)] * t.jacobian.row(i).transpose();
  ToolTerms& now = to.tools[tool];
  for (int i = 0; i < n; ++i) {
    const int s = i < first ? i : i + weld_rows;
    const std::size_t d = std::size_t(i);
    for (int k = 0; k < 6; ++k) body_[d][k] = from.w_at(s, first + k) - w_tools(from, s, first + k);
    tool_[d] = t.jacobian.row(s).transpose();
    const Vec6 share = p * body_[d];  // of the grasped body's displacement by its six rows
    both_[d] = tool_[d] - h_joint.transpose() * share;
    now.jacobian.row(i) = both_[d].transpose();
    to.rate[d] -= share.dot(rate_joint);
    push_now += to.lambda[d] * both_[d];
  }
  for (int i = 0; i < n; ++i) {
    const int s = i < first ? i : i + weld_rows;
    const Vec6 by_tool = t.compliance * tool_[std::size_t(i)], by_grasped = p * body_[std::size_t(i)],
               by_both = give * both_[std::size_t(i)];
    double delta = from.delta_free[std::size_t(s)], delta_now = 0;
    for (int j = 0; j < from.rows; ++j) delta += from.w_at(s, j) * from.lambda[std::size_t(j)];
    for (int j = 0; j < n; ++j) {
      const std::size_t c = std::size_t(j);
      double w = from.w_at(s, j < first ? j : j + weld_rows) - by_tool.dot(tool_[c]) - by_grasped.dot(body_[c]);
      w += by_both.dot(both_[c]);
      to.w[std::size_t(i) * std::size_t(to.stride) + c] = w;
      delta_now += w * to.lambda[c];
    }
    to.delta_free[std::size_t(i)] = delta - delta_now;
  }
  for (int i = 0; i < n; ++i)
    if (to.w_at(i, i) < nothing * from.w_at(i < first ? i : i + weld_rows, i < first ? i : i + weld_rows))
      silence(to, tool, i);
  now.gain = give * (a * t.gain);
  now.compliance = 0.5 * (give + give.transpose());
  now.free = displaced(t.free, t.compliance * push - now.compliance * push_now);
  grasped_[tool].any = true;
  grasped_[tool].velocity = -kinematics.solve(rate_joint);
  return true;
}

}  // namespace insula
