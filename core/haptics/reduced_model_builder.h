// SPDX-License-Identifier: GPL-3.0-or-later
// Adds a reduced dynamic model (core/constraint/reduced_model.h) of the bodies near the tools to each problem.
//
// The modes are computed when a problem has been sent, so they delay no force. The next problem uses them with its own
// rows, velocities and forces. Bodies keep no modes over a step in which no tool was near.
#pragma once
#include <map>

#include "core/constraint/problem.h"
#include "core/haptics/reduced_basis.h"

namespace insula {

class ReducedModelBuilder {
 public:
  /// Begins the problem of a step with this number. A gap since the last one makes all bodies start anew.
  void begin(long step);
  /// Adds a body's modes to the problem. `compliance`: of each of the problem's rows by the body alone, m/N.
  void add(const DeformableBody& body, const BodyRows& rows, std::span<const double> compliance,
           ConstraintProblem& problem);
  /// Computes the modes of a body of this problem for the next one, with the factor of the last step.
  void compute(const DeformableBody& body, BodySolver& solver, std::span<const ReducedBasis::Loaded> loaded,
               const double* w, int stride) {
    basis_[&body].basis.compute(body, solver, loaded, w, stride);
  }

 private:
  struct Entry {
    ReducedBasis basis;
    long step = -1;  ///< in which it was used last
  };
  std::map<const DeformableBody*, Entry> basis_;
  long step_ = -1;
  bool again_ = false;  ///< another problem of the same step
};

}  // namespace insula
