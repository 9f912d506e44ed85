// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/sim/defect_correction.h"

#include <algorithm>
#include <cmath>

namespace insula {

void DefectCorrection::begin(ConstraintProblem& problem, const std::vector<Body*>& bodies) {
  bodies_.clear();
  for (Body* b : bodies)
    if (b->active() && !b->exact() && b->rows.count() > 0) bodies_.push_back(b);
  if (bodies_.empty()) return;
  w_.assign(problem.w.size(), 0.0);
  for (Body* b : bodies_) b->add_compliance(b->rows, w_.data(), problem.stride);
  free_.assign(problem.delta_free.begin(), problem.delta_free.end());
  for (const Body* b : bodies_) b->subtract_lagged(b->rows, problem.delta_free.data());
}

double DefectCorrection::pass(ConstraintProblem& problem, const double* lambda, Workers& workers) {
  workers.run(int(bodies_.size()),
              [&](int i) { bodies_[std::size_t(i)]->apply_compliance(bodies_[std::size_t(i)]->rows, lambda); });
  before_.assign(problem.delta_free.begin(), problem.delta_free.end());
  std::copy(free_.begin(), free_.end(), problem.delta_free.begin());
  for (const Body* b : bodies_) b->add_applied_compliance(b->rows, problem.delta_free.data());
  double most = 0;
  for (int i = 0; i < problem.rows; ++i) {
    const double* w = w_.data() + std::size_t(i) * std::size_t(problem.stride);
    double known = 0;
    for (int j = 0; j < problem.rows; ++j) known += w[j] * lambda[j];
    problem.delta_free[std::size_t(i)] -= known;
    most = std::max(most, std::abs(problem.delta_free[std::size_t(i)] - before_[std::size_t(i)]));
  }
  return most;
}

}  // namespace insula
