// SPDX-License-Identifier: GPL-3.0-or-later
// Integration of the reduced dynamic model of tissue (core/constraint/reduced_model.h) from tick to tick.
//
// Implicit Euler over a tick of dt, mode by mode, with phi = V^T H^T lambda of all rows and phi_0 that of the problem:
//   dz = D (f + phi - phi_0 - k z + (m/dt) z'),   D = 1 / (m/dt^2 + c/dt + k)
// In a tick, dz = (dz for the forces of the tick before) + D g^T (change of lambda), so a row gets g D g^T in the
// tick's W, and g dz in its gap. Nothing that happens in a mode by itself increases its energy m z'^2/2 + k z^2/2.
#pragma once
#include <span>
#include <vector>

#include "core/constraint/reduced_model.h"

namespace insula {

/// Allocates only in its constructor.
class ReducedDynamics {
 public:
  ReducedDynamics();
  /// Starts the model of a problem of length `step_s` at rest about the end of its step; null: none.
  void begin(const ReducedModel* model, double step_s) noexcept;
  bool any() const noexcept { return !z_.empty(); }
  std::size_t modes() const noexcept { return z_.size(); }

  /// Sets the length of the ticks that follow.
  void set_tick(double dt_s) noexcept;
  /// D of each mode in a tick.
  std::span<const double> compliance() const noexcept { return compliance_; }
  /// Adds the force of a row with this participation to phi of the last tick.
  void add_force(const double* participation, double lambda) noexcept {
    for (std::size_t s = 0; s < z_.size(); ++s) phi_[s] += participation[s] * lambda;
  }
  void clear_force() noexcept { phi_.assign(phi_.size(), 0.0); }
  /// phi is that of the problem.
  void forces_are_of_the_problem() noexcept { phi_problem_ = phi_; }
  /// dz of the tick with the present phi.
  void predict() noexcept;
  /// Ends the tick with the present phi.
  void advance() noexcept;
  /// m z'^2/2 + k z^2/2 of all modes, J.
  double energy() const noexcept;

  /// Of a row with this participation: in the tick, as predicted or advanced last.
  double displacement(const double* participation) const noexcept { return dot(participation, dz_); }
  /// The part of it that the forces phi have made.
  double response(const double* participation) const noexcept {
    double sum = 0;
    for (std::size_t s = 0; s < z_.size(); ++s) sum += participation[s] * compliance_[s] * phi_[s];
    return sum;
  }
  double rate(const double* participation) const noexcept { return dot(participation, velocity_); }

 private:
  double dot(const double* p, const std::vector<double>& x) const noexcept {
    double sum = 0;
    for (std::size_t s = 0; s < x.size(); ++s) sum += p[s] * x[s];
    return sum;
  }
  const ReducedModel* model_ = nullptr;
  double dt_ = 0;
  std::vector<double> stiffness_, z_, velocity_, phi_, phi_problem_, compliance_, dz_;
};

}  // namespace insula
