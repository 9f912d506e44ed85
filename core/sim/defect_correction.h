// SPDX-License-Identifier: GPL-3.0-or-later
// Defect correction (Stetter 1978) for bodies whose compliance is approximate. With W in the problem and V the true
// matrix,
//     V lambda + delta_free = W lambda + (delta_free + (V - W) lambda_k)   at lambda = lambda_k,
// so the problem is solved again with the bracket in place of delta_free. Each pass reduces the error by the factor
// |W^-1 (V - W)|, and the fixed point is the exact step. If the free motion contains the last step's forces
// (BodySolver::begin_motion), the first bracket subtracts their effect as W gives it, and the true motion gives the
// rest. The problem for the hands has the same bracket, so the servo begins at the solution of the step.
#pragma once
#include <vector>

#include "core/base/workers.h"
#include "core/constraint/problem.h"
#include "core/mechanics/dynamic_body.h"

namespace insula {

class InexactSolver;

class DefectCorrection {
 public:
  /// Called when the problem's W is complete: sets delta_free to the first bracket.
  void begin(ConstraintProblem& problem, const std::vector<DynamicBody*>& bodies);
  /// Whether the compliance of any body is approximate.
  bool needed() const { return !bodies_.empty(); }
  /// Sets problem.delta_free to the bracket for lambda. Returns the largest change of a row since the last pass, m.
  double pass(ConstraintProblem& problem, const double* lambda, Workers& workers);

 private:
  struct Inexact {
    InexactSolver* solver;
    const BodyRows* rows;
  };
  std::vector<Inexact> bodies_;
  std::vector<double> w_, free_, before_;
};

}  // namespace insula
