// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/sim/defect_correction.h"

#include <algorithm>
#include <cmath>

#include "core/linalg/inexact_solver.h"

namespace insula {

void DefectCorrection::begin(ConstraintProblem& problem, const std::vector<DynamicBody*>& bodies) {
  bodies_.clear();
  for (DynamicBody* b : bodies) {
    BodySolver* solver = b->active() && b->rows.count() > 0 ? b->solver() : nullptr;
    if (InexactSolver* inexact = solver ? solver->inexact() : nullptr) bodies_.push_back({inexact, &b->rows});
  }
  if (bodies_.empty()) return;
  w_.assign(problem.w.size(), 0.0);
  for (const Inexact& b : bodies_) b.solver->add_compliance(*b.rows, w_.data(), problem.stride);
  free_.assign(problem.delta_free.begin(), problem.delta_free.end());
  for (const Inexact& b : bodies_) b.solver->subtract_lagged(*b.rows, problem.delta_free.data());
}

double DefectCorrection::pass(ConstraintProblem& problem, const double* lambda, Workers& workers) {
  workers.run(int(bodies_.size()),
              [&](int i) { bodies_[std::size_t(i)].solver->correct(*bodies_[std::size_t(i)].rows, lambda); });
  before_.assign(problem.delta_free.begin(), problem.delta_free.end());
  std::copy(free_.begin(), free_.end(), problem.delta_free.begin());
  for (const Inexact& b : bodies_) b.solver->add_correction(*b.rows, problem.delta_free.data());
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
