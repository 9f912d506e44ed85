// SPDX-License-Identifier: GPL-3.0-or-later
// Correction of rows from tick to tick.
#include "haptic_server/substep_correction.h"

#include <algorithm>
#include <cmath>

#include "haptic_server/tick_share.h"

namespace insula {
namespace {

constexpr double shortest_s = 1e-5;  // a tick of zero length would make tissue rigid
constexpr double same_length = 0.1;  // ticks whose lengths differ by less share a W

}  // namespace

SubstepCorrection::SubstepCorrection(const SubstepCorrectionSettings& settings, int max_rows)
    : settings_(settings), extrapolation_(max_rows), failure_(max_rows) {
  tick_.resize(max_rows);
  tick_.blocks.reserve(std::size_t(max_rows));
  for (auto* v : {&gap_, &rate_, &known_, &share_}) v->assign(std::size_t(max_rows), 0.0);
  slips_.assign(std::size_t(max_rows), 0);
  tool_coupled_.reserve(std::size_t(max_rows));
  touching_.reserve(std::size_t(max_rows));
  w_residual_.reserve(tick_.w.size());
}

void SubstepCorrection::begin(const ConstraintProblem& p, const std::array<GraspedBody, 2>& grasped, double age_s,
                              PatchContacts* patches) noexcept {
  step_ = &p;
  patches_ = patches;
  grasped_ = grasped;
  const std::size_t n = std::size_t(p.rows);
  tick_.resize(p.rows);  // within its capacity, as the blocks
  tick_.blocks.assign(p.blocks.begin(), p.blocks.end());
  std::copy_n(p.lambda.begin(), n, known_.begin());
  std::fill_n(slips_.begin(), n, char(0));
  for (const Block& b : p.blocks) {
    for (int k = b.law == LawKind::friction ? 1 : 0; k < b.rows() && b.law != LawKind::box; ++k)
      slips_[std::size_t(b.row + k)] = settings_.incremental_slip;
    if (PredictedFailure::plastic(b))
      slips_[std::size_t(b.row)] = settings_.predict_failure && known_[std::size_t(b.row)] != 0;
  }
  for (std::size_t i = 0; i < n; ++i) {
    double gap = p.delta_free[i];
    const double* w = p.w.data() + i * std::size_t(p.stride);
    for (std::size_t j = 0; j < n; ++j) gap += w[j] * p.lambda[j];
    gap_[i] = gap;
    rate_[i] = p.rate[i];
  }
  if (settings_.predict_failure) failure_.begin(p, {gap_.data(), n});
  find_tool_coupled_rows();
  extrapolation_.begin(p, grasped);
  begin_dynamics();
  for (std::size_t t = 0; t < tools(); ++t) {
    moved_[t].setZero();
    push_[t] = push(t, p.lambda) + patch_push(t);
    if (grasped_[t].any) grasping_[t].begin(p.tools[t], p.step_s, grasped_[t].velocity, push_[t]);
    else grasping_[t].lose();
  }
  age_ = std::isfinite(age_s) ? age_s : 0;
  compliance_dt_ = 0;
  first_ = true;
}

// Splits W and the rates into those of the modes and the rest.
void SubstepCorrection::begin_dynamics() noexcept {
  const ConstraintProblem& p = *step_;
  const ReducedModel& model = p.reduced;
  const bool used =
      settings_.reduced_dynamics && settings_.substep_compliance && settings_.extrapolate_tissue && !model.empty();
  dynamics_.begin(used ? &model : nullptr, p.step_s);
  if (patches_) patches_->begin_dynamics(dynamics_.any() ? &dynamics_ : nullptr);
  if (!dynamics_.any()) return;
  const std::size_t n = std::size_t(p.rows);
  w_residual_.assign(p.w.begin(), p.w.begin() + std::ptrdiff_t(n) * p.stride);  // within its capacity
  std::array<double, ReducedModel::max_modes> minus_one;
  minus_one.fill(-1);
  add_modes(w_residual_.data(), minus_one);
  for (std::size_t i = 0; i < n; ++i) {
    rate_[i] -= dynamics_.rate(model.row(i));
    dynamics_.add_force(model.row(i), known_[i]);
  }
  if (patches_) patches_->add_forces();
  dynamics_.forces_are_of_the_problem();
}

// w += g diag(weight) g^T, group by group.
void SubstepCorrection::add_modes(double* w, std::span<const double> weight) noexcept {
  const ReducedModel& model = step_->reduced;
  const std::size_t n = std::size_t(step_->rows), stride = std::size_t(step_->stride);
  for (const ReducedModel::Group& g : model.groups) {
    touching_.clear();
    for (std::size_t i = 0; i < n; ++i)
      if (model.touches(i, g)) touching_.push_back(int(i));
    const auto first = std::size_t(g.first), count = std::size_t(g.modes);
    for (std::size_t a = 0; a < touching_.size(); ++a) {
      const auto i = std::size_t(touching_[a]);
      std::array<double, ReducedModel::max_modes> scaled;
      for (std::size_t s = 0; s < count; ++s) scaled[s] = model.row(i)[first + s] * weight[first + s];
      for (std::size_t b = 0; b <= a; ++b) {
        const auto j = std::size_t(touching_[b]);
        const double* other = model.row(j) + first;
        double sum = 0;
        for (std::size_t s = 0; s < count; ++s) sum += scaled[s] * other[s];
        w[i * stride + j] += sum;
        if (i != j) w[j * stride + i] += sum;
      }
    }
  }
}

void SubstepCorrection::find_tool_coupled_rows() noexcept {
  tool_coupled_.clear();
  for (int i = 0; i < step_->rows; ++i) {
    bool tool_coupled = false;
    for (std::size_t t = 0; t < tools(); ++t)
      for (int c = 0; c < 6; ++c) tool_coupled = tool_coupled || step_->tools[t].jacobian(i, c) != 0;
    if (tool_coupled) tool_coupled_.push_back(i);
  }
}

Vec6 SubstepCorrection::push(std::size_t tool, std::span<const double> lambda) const noexcept {
  Vec6 sum = Vec6::Zero();
  for (const int i : tool_coupled_)
    for (int c = 0; c < 6; ++c) sum[c] += extrapolation_.jacobian(tool)(i, c) * lambda[std::size_t(i)];
  return sum;
}

// Compliance of the tools in dt, and the share of the other compliance that acts within dt.
void SubstepCorrection::scale_compliance(double dt) noexcept {
  const ConstraintProblem& p = *step_;
  const std::size_t n = std::size_t(p.rows), stride = std::size_t(tick_.stride);
  const double h = p.step_s;
  for (std::size_t i = 0; i < n; ++i) {
    const double beta = p.retardation_time[i];
    share_[i] = settings_.substep_compliance && h > 0 ? tick_share(dt, h, beta) : 1.0;
  }
  const double* w = dynamics_.any() ? w_residual_.data() : p.w.data();
  for (std::size_t i = 0; i < n; ++i)
    for (std::size_t j = 0; j < n; ++j) tick_.w[i * stride + j] = share_[i] * share_[j] * w[i * stride + j];
  if (dynamics_.any()) {
    dynamics_.set_tick(dt);
    add_modes(tick_.w.data(), dynamics_.compliance());
  }
  for (std::size_t t = 0; t < tools(); ++t)
    for (const int a : tool_coupled_) {
      Vec6 step = Vec6::Zero(), tick = Vec6::Zero();
      for (int c = 0; c < 6; ++c)
        for (int k = 0; k < 6; ++k) {
          step[c] += p.tools[t].compliance(c, k) * p.tools[t].jacobian(a, k);
          tick[c] += give(t)(c, k) * p.tools[t].jacobian(a, k);
        }
      for (const int b : tool_coupled_) {
        const double share = share_[std::size_t(a)] * share_[std::size_t(b)];
        double sum = 0;
        for (int c = 0; c < 6; ++c) sum += p.tools[t].jacobian(b, c) * (tick[c] - share * step[c]);
        tick_.w[std::size_t(a) * stride + std::size_t(b)] += sum;
      }
    }
  if (patches_) patches_->scale(dt, h, settings_.substep_compliance);
  compliance_dt_ = dt;
}

const ConstraintProblem& SubstepCorrection::next(double dt, const std::array<Vec6, 2>& moved) noexcept {
  const ConstraintProblem& p = *step_;
  const std::size_t n = std::size_t(p.rows), stride = std::size_t(tick_.stride);
  dt = std::max(dt, shortest_s);
  dt_ = first_ ? std::max(age_, shortest_s) : dt;
  if (first_ || std::abs(dt_ - compliance_dt_) > same_length * dt_ || second_) {
    for (std::size_t t = 0; t < tools(); ++t)
      if (grasped_[t].any) grasping_[t].set_tick(dt, dt_);
    scale_compliance(dt_);
  }
  second_ = first_;
  first_ = false;
  if (settings_.extrapolate_frames) extrapolation_.extrapolate(moved);
  for (std::size_t t = 0; t < tools(); ++t) {
    const Vec6 push_change =
        settings_.extrapolate_frames ? Vec6(push(t, known_) + patch_push(t) - push_[t]) : Vec6(Vec6::Zero());
    push_[t] += push_change;
    if (grasped_[t].any) {
      went_[t] = grasping_[t].free_displacement(moved[t]) + give(t) * push_[t];
      continue;
    }
    const Vec6 free = p.tools[t].gain * moved[t];
    went_[t] = free - moved_[t] + give(t) * push_change;
    moved_[t] = free;
  }
  dynamics_.predict();
  if (settings_.predict_failure) {
    failure_.apply(tick_.blocks);
    released_ = failure_.take_release();
  }
  for (std::size_t i = 0; i < n; ++i) {
    double free = start(i);
    if (dynamics_.any()) free += dynamics_.displacement(p.reduced.row(i));
    if (settings_.extrapolate_tissue) {
      const double beta = p.retardation_time[i], last = settings_.substep_compliance ? dt_ : p.step_s;
      free += beta / (beta + last) * dt_ * rate_[i];
    }
    const double* w = tick_.w.data() + i * stride;
    for (std::size_t j = 0; j < n; ++j) free -= w[j] * known_[j];
    for (std::size_t t = 0; t < tools(); ++t)
      for (int c = 0; c < 6; ++c) free += extrapolation_.jacobian(t)(int(i), c) * went_[t][c];
    tick_.delta_free[i] = free;
  }
  return patches_ ? with_patches(moved) : tick_;
}

// Takes the effect of the last forces on patches out of the rows, and adds the rows of the contacts found now.
const ConstraintProblem& SubstepCorrection::with_patches(const std::array<Vec6, 2>& moved) noexcept {
  const ConstraintProblem& p = *step_;
  const std::size_t n = std::size_t(p.rows);
  patches_->subtract_known({share_.data(), n}, {tick_.delta_free.data(), n});
  std::array<PatchContacts::Tool, 2> tool;
  for (std::size_t t = 0; t < tools(); ++t) {
    const ToolTerms& terms = p.tools[t];
    tool[t].pose = grasped_[t].any ? displaced(grasping_[t].pose(), went_[t])
                                   : displaced(terms.free, terms.gain * moved[t] + terms.compliance * push_[t]);
    tool[t].went = went_[t];
    tool[t].push = push_[t];
    tool[t].give = &give(t);
    tool[t].jacobian = &extrapolation_.jacobian(t);
    const Vec6 back = give(t) * patches_->push(t);
    for (const int i : tool_coupled_)
      for (int c = 0; c < 6; ++c) tick_.delta_free[std::size_t(i)] -= extrapolation_.jacobian(t)(i, c) * back[c];
  }
  return patches_->next(tick_, {share_.data(), n}, {known_.data(), n}, {tool.data(), tools()}, dt_,
                        settings_.extrapolate_tissue);
}

void SubstepCorrection::solved(std::span<const double> lambda, std::span<const double> delta) noexcept {
  const ConstraintProblem& p = *step_;
  const std::size_t n = std::size_t(p.rows);
  if (settings_.predict_failure) failure_.solved(lambda, delta, dt_);
  if (patches_) patches_->take_forces(lambda, n);
  if (dynamics_.any()) {
    dynamics_.clear_force();
    for (std::size_t i = 0; i < n; ++i) dynamics_.add_force(p.reduced.row(i), lambda[i]);
    if (patches_) patches_->add_forces();
    dynamics_.advance();
  }
  if (patches_) patches_->move(lambda, {share_.data(), n}, {known_.data(), n}, dt_, settings_.substep_compliance);
  // Displacement of the tools: their free displacement, and that by the change of force.
  std::array<Vec6, 2> swept = went_;
  for (std::size_t t = 0; t < tools(); ++t) {
    const Vec6 now = push(t, lambda) + patch_push(t);
    swept[t] += give(t) * (now - push_[t]);
    push_[t] = now;
    if (grasped_[t].any) grasping_[t].went(swept[t]);
  }
  for (std::size_t i = 0; i < n; ++i) {
    double tissue = delta[i] - start(i);
    if (dynamics_.any()) tissue -= dynamics_.displacement(p.reduced.row(i));
    for (std::size_t t = 0; t < tools(); ++t)
      for (int c = 0; c < 6; ++c) tissue -= extrapolation_.jacobian(t)(int(i), c) * swept[t][c];
    if (settings_.substep_compliance) rate_[i] = tissue / dt_;
    gap_[i] = delta[i];
    known_[i] = lambda[i];
  }
  // A rigid-plastic row resists every displacement from its first touch on.
  if (settings_.predict_failure)
    for (const Block& b : p.blocks)
      if (PredictedFailure::plastic(b) && lambda[std::size_t(b.row)] != 0) slips_[std::size_t(b.row)] = 1;
}

}  // namespace insula
