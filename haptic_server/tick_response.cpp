// SPDX-License-Identifier: GPL-3.0-or-later
// Rows from tick to tick.
#include "haptic_server/tick_response.h"

#include <algorithm>
#include <cmath>

namespace insula {
namespace {

constexpr double shortest_s = 1e-5;  // a tick of no length would leave tissue no compliance
constexpr double same_length = 0.1;  // ticks that differ by less share a W

}  // namespace

TickResponse::TickResponse(const TickResponseSettings& settings, int most_rows) : settings_(settings) {
  tick_.resize(most_rows);
  tick_.blocks.reserve(std::size_t(most_rows));
  for (auto* v : {&gap_, &rate_, &known_, &share_}) v->assign(std::size_t(most_rows), 0.0);
  tool_answer_.assign(std::size_t(most_rows) * 12, 0.0);
  slips_.assign(std::size_t(most_rows), 0);
  felt_.reserve(std::size_t(most_rows));
}

void TickResponse::begin(const ConstraintProblem& p, double age_s) noexcept {
  step_ = &p;
  const std::size_t n = std::size_t(p.rows);
  tick_.resize(p.rows);  // within its capacity, and so are the blocks
  tick_.blocks.assign(p.blocks.begin(), p.blocks.end());
  std::copy_n(p.lambda.begin(), n, known_.begin());
  std::fill_n(slips_.begin(), n, char(0));
  for (const Block& b : p.blocks)
    for (int k = b.law == LawKind::friction ? 1 : 0; k < b.rows() && b.law != LawKind::box; ++k) slips_[std::size_t(b.row + k)] = 1;
  for (std::size_t i = 0; i < n; ++i) {
    double gap = p.delta_free[i];
    const double* w = p.w.data() + i * std::size_t(p.stride);
    for (std::size_t j = 0; j < n; ++j) gap += w[j] * p.lambda[j];
    gap_[i] = gap;
    rate_[i] = p.rate[i];
  }
  felt_.clear();
  std::fill_n(tool_answer_.begin(), 12 * n, 0.0);
  for (std::size_t t = 0; t < tools(); ++t) moved_[t].setZero();
  for (int i = 0; i < p.rows; ++i) {
    bool felt = false;
    for (std::size_t t = 0; t < tools(); ++t) {
      const ToolTerms& tool = p.tools[t];
      for (int c = 0; c < 6; ++c) {
        double sum = 0;
        for (int k = 0; k < 6; ++k) sum += tool.compliance(c, k) * tool.jacobian(i, k);
        tool_answer_[12 * std::size_t(i) + 6 * t + std::size_t(c)] = sum;
        felt = felt || sum != 0;
      }
    }
    if (felt) felt_.push_back(i);
  }
  age_ = std::isfinite(age_s) ? age_s : 0;
  compliance_dt_ = 0;
  first_ = true;
}

// W_tool as it is, the rest as much as tissue yields in dt.
void TickResponse::scale_compliance(double dt) noexcept {
  const ConstraintProblem& p = *step_;
  const std::size_t n = std::size_t(p.rows), stride = std::size_t(tick_.stride);
  const double h = p.step_s;
  for (std::size_t i = 0; i < n; ++i) {
    const double beta = p.relaxation[i];
    share_[i] = settings_.tissue_in_time && h > 0 ? std::sqrt(dt / (beta + dt) * (h + beta) / h) : 1.0;
  }
  for (std::size_t i = 0; i < n; ++i)
    for (std::size_t j = 0; j < n; ++j) tick_.w[i * stride + j] = share_[i] * share_[j] * p.w_at(int(i), int(j));
  for (const int a : felt_)
    for (const int b : felt_) {
      double sum = 0;
      for (std::size_t t = 0; t < tools(); ++t)
        for (int c = 0; c < 6; ++c) sum += p.tools[t].jacobian(b, c) * tool_answer_[12 * std::size_t(a) + 6 * t + std::size_t(c)];
      tick_.w[std::size_t(a) * stride + std::size_t(b)] += (1 - share_[std::size_t(a)] * share_[std::size_t(b)]) * sum;
    }
  compliance_dt_ = dt;
}

const ConstraintProblem& TickResponse::next(double dt, const std::array<Vec6, 2>& moved) noexcept {
  const ConstraintProblem& p = *step_;
  const std::size_t n = std::size_t(p.rows), stride = std::size_t(tick_.stride);
  dt_ = std::max(first_ ? age_ : dt, shortest_s);
  first_ = false;
  if (std::abs(dt_ - compliance_dt_) > same_length * dt_) scale_compliance(dt_);
  for (std::size_t t = 0; t < tools(); ++t) went_[t] = moved[t] - moved_[t];
  for (std::size_t i = 0; i < n; ++i) {
    double free = start(i);
    if (settings_.tissue_moves) {
      const double beta = p.relaxation[i], last = settings_.tissue_in_time ? dt_ : p.step_s;
      free += beta / (beta + last) * dt_ * rate_[i];
    }
    const double* w = tick_.w.data() + i * stride;
    for (std::size_t j = 0; j < n; ++j) free -= w[j] * known_[j];
    for (std::size_t t = 0; t < tools(); ++t)
      for (int c = 0; c < 6; ++c) free += p.tools[t].jacobian(int(i), c) * went_[t][c];
    tick_.delta_free[i] = free;
  }
  moved_ = moved;
  return tick_;
}

void TickResponse::solved(std::span<const double> lambda, std::span<const double> delta) noexcept {
  const ConstraintProblem& p = *step_;
  // What the tools did: their free way and what the change of force makes them yield.
  std::array<Vec6, 2> way = went_;
  for (std::size_t t = 0; t < tools(); ++t) {
    Vec6 push = Vec6::Zero();
    for (const int i : felt_)
      for (int c = 0; c < 6; ++c) push[c] += p.tools[t].jacobian(i, c) * (lambda[std::size_t(i)] - known_[std::size_t(i)]);
    way[t] += p.tools[t].compliance * push;
  }
  for (std::size_t i = 0; i < std::size_t(p.rows); ++i) {
    double tissue = delta[i] - start(i);
    for (std::size_t t = 0; t < tools(); ++t)
      for (int c = 0; c < 6; ++c) tissue -= p.tools[t].jacobian(int(i), c) * way[t][c];
    if (settings_.tissue_in_time) rate_[i] = tissue / dt_;
    gap_[i] = delta[i];
    known_[i] = lambda[i];
  }
}

}  // namespace insula
