// SPDX-License-Identifier: GPL-3.0-or-later
// Modes in a tick.
#include "haptic_server/reduced_dynamics.h"

#include <algorithm>

namespace insula {

ReducedDynamics::ReducedDynamics() {
  for (auto* v : {&stiffness_, &z_, &velocity_, &phi_, &phi_problem_, &compliance_, &dz_})
    v->reserve(ReducedModel::max_modes);
}

void ReducedDynamics::begin(const ReducedModel* model, double step_s) noexcept {
  model_ = model && step_s > 0 && model->modes.size() <= ReducedModel::max_modes ? model : nullptr;
  const std::size_t n = model_ ? model_->modes.size() : 0;
  for (auto* v : {&stiffness_, &z_, &velocity_, &phi_, &phi_problem_, &compliance_, &dz_}) v->assign(n, 0.0);
  for (std::size_t s = 0; s < n; ++s) {
    const ReducedModel::Mode& m = model_->modes[s];
    stiffness_[s] = std::max(0.0, m.stiffness(step_s));  // rounding of the message
    velocity_[s] = m.velocity;
  }
}

void ReducedDynamics::set_tick(double dt_s) noexcept {
  dt_ = dt_s;
  for (std::size_t s = 0; s < z_.size(); ++s) {
    const ReducedModel::Mode& m = model_->modes[s];
    const double a = m.mass_s2 / (dt_ * dt_) + m.damping_s / dt_ + stiffness_[s];
    compliance_[s] = a > 0 ? 1 / a : 0;
  }
}

void ReducedDynamics::predict() noexcept {
  for (std::size_t s = 0; s < z_.size(); ++s) {
    const ReducedModel::Mode& m = model_->modes[s];
    dz_[s] =
        compliance_[s] * (m.force + phi_[s] - phi_problem_[s] - stiffness_[s] * z_[s] + m.mass_s2 / dt_ * velocity_[s]);
  }
}

void ReducedDynamics::advance() noexcept {
  predict();
  for (std::size_t s = 0; s < z_.size(); ++s) {
    z_[s] += dz_[s];
    velocity_[s] = dz_[s] / dt_;
  }
}

double ReducedDynamics::energy() const noexcept {
  double sum = 0;
  for (std::size_t s = 0; s < z_.size(); ++s)
    sum += 0.5 * (model_->modes[s].mass_s2 * velocity_[s] * velocity_[s] + stiffness_[s] * z_[s] * z_[s]);
  return sum;
}

}  // namespace insula
