// SPDX-License-Identifier: GPL-3.0-or-later
// Puts right what W lacks where a body knows its compliance only nearly. With W the one in the problem and V the true
// one,
//     V lambda + delta_free = W lambda + (delta_free + (V - W) lambda_k)   at lambda = lambda_k,
// so the problem is solved again with the bracket in place of delta_free. Each pass makes the error smaller by |W^-1 (V
// - W)|; its fixed point is the exact step. Where free motion is that under the last step's forces
// (BodySolver::begin_motion), the first bracket takes off what W knows of them, and the true motion tells the rest. The
// problem that the hands get has the same bracket: the servo begins at the step's own solution.
#pragma once
#include <vector>

#include "core/base/workers.h"
#include "core/constraint/problem.h"
#include "core/mechanics/dynamic_body.h"

namespace insula {

class InexactSolver;

class DefectCorrection {
 public:
  /// When the problem's W is complete: sets delta_free to the first bracket.
  void begin(ConstraintProblem& problem, const std::vector<DynamicBody*>& bodies);
  /// Whether there is a body that knows its compliance only nearly.
  bool needed() const { return !bodies_.empty(); }
  /// Sets problem.delta_free to the bracket for lambda; returns the largest change of a row since the last pass, m.
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
