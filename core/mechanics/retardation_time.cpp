// SPDX-License-Identifier: GPL-3.0-or-later
// Retardation time of a deformable body at each position. Each of its force models has a time of its own, viscous over
// elastic, and a unit load strains all of them.
//
// With A = M/h^2 + sum_j (1 + T_j/h) K_j and x = A^-1 f the displacement by the unit load f in a step, it is the mean
// weighted with the energies,
//   T = sum_j T_j x^T K_j x / sum_j x^T K_j x,
// which without inertia also follows from the compliance W = f^T x alone: T = -W' / (W + W'/h), W' = dW/d(1/h).
#include <algorithm>

#include "core/collision/search/vertex_groups.h"
#include "core/mechanics/deformable_body.h"

namespace insula {

// Starts with the largest time of the models. This is the result if all are equal, or if the solver is not exact.
void DeformableBody::start_retardation_times() {
  double slowest = 0;
  for (const ForceModel* f : forces_) slowest = std::max(slowest, f->stiffness_damping());
  retardation_time_.assign(std::size_t(nodes()), slowest);
  retardation_times_known_ =
      solver_->inexact() || std::all_of(forces_.begin(), forces_.end(),
                                        [&](const ForceModel* f) { return f->stiffness_damping() == slowest; });
}

// Uses the factor of a_. The spatial resolution is that of some dozens of unit loads.
void DeformableBody::find_retardation_times(double h) {
  constexpr int unit_loads = 64;
  retardation_times_known_ = true;
  std::vector<BlockMatrix> stiffness(forces_.size(), a_);
  VecX scratch = VecX::Zero(3 * nodes());
  for (std::size_t j = 0; j < forces_.size(); ++j) {
    stiffness[j].set_zero();
    forces_[j]->linearise(q_.data(), scratch.data(), &stiffness[j], h, Tangent::system);
  }
  const std::vector<int> group = group_by_position(rest_nodes(), unit_loads);
  std::vector<double> time(unit_loads, -1.0);
  VecX x(3 * free_count_), force(3 * free_count_);
  for (int i = 0; i < nodes(); ++i) {
    const int b = free_[std::size_t(i)];
    double& mean = time[std::size_t(group[std::size_t(i)])];
    if (b < 0 || mean >= 0) continue;
    double elastic = 0, viscous = 0;
    for (int axis = 0; axis < 3; ++axis) {
      x.setZero();
      x[3 * b + axis] = 1;
      solver_->solve(x.data());
      for (std::size_t j = 0; j < forces_.size(); ++j) {
        force.setZero();
        stiffness[j].add_product(x.data(), force.data());
        const double own = forces_[j]->stiffness_damping(), energy = x.dot(force) / (1 + own / h);
        elastic += energy;
        viscous += own * energy;
      }
    }
    if (elastic > 0) mean = viscous / elastic;
  }
  for (int i = 0; i < nodes(); ++i)
    if (const double mean = time[std::size_t(group[std::size_t(i)])]; mean >= 0)
      retardation_time_[std::size_t(i)] = mean;
  // Models keep what they found in their last linearisation, such as rotations. They are left as in later runs, where
  // a step linearises them once.
  for (ForceModel* f : forces_) {
    f->reset();
    f->linearise(q_.data(), scratch.data(), nullptr, h, Tangent::system);
  }
  for (ForceModel* f : damped_) f->linearise_damping(q_.data(), v_.data(), scratch.data(), nullptr, h);
}

double DeformableBody::retardation_time(const MaterialPoint& p) const {
  double time = 0;
  for (int k = 0; k < p.count; ++k)
    time += p.weight[std::size_t(k)] * retardation_time_[std::size_t(p.node[std::size_t(k)])];
  return std::max(0.0, time);
}

}  // namespace insula
