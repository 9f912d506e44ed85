// SPDX-License-Identifier: GPL-3.0-or-later
// Prediction of the frames of tool contacts at the end of the step, and soon after it, for the servo.
//
// A step takes its normals at its start. When the problem reaches the servo, they are more than a step old. Beyond an
// edge of the surface the normal is then another one. The three rows of a contact with friction are the three
// directions of space at one point. The problem in other directions follows exactly from a rotation Q of each block:
//   H' = Q H,   W' = Q W Q^T,   rate' = Q rate,   delta' = Q delta; the gap of pressing contacts stays
// lambda' is its solution. The engine's own step does not change.
//
// Each block also gets its predicted rotation over one more step. The servo continues this rotation with the tool.
#pragma once
#include "core/constraint/solve.h"
#include "core/sim/simulation.h"

namespace insula {

/// Rotates the three rows of a contact that begin at `row` by q. `delta_m`: delta of the problem at its lambda, m; it
/// is rotated too.
void rotate_contact_rows(ConstraintProblem& problem, int row, const Mat3& q, std::span<double> delta_m);

class ContactFramePrediction {
 public:
  /// `problem`, that of the simulation's last step, with its contact frames `ahead_s` (s) after the step, if the tools
  /// move on as in the step. Contacts that the servo replaces keep their frames. It is `problem` itself if no other
  /// contact presses. Valid until the next call or step.
  const ConstraintProblem& operator()(const Simulation& simulation, const ConstraintProblem& problem, double ahead_s);

 private:
  ConstraintProblem predicted_;
  std::vector<ContactFrame> frames_;
  AlignedVector<double> delta_m_, work_;
  SolveWorkspace workspace_;
};

}  // namespace insula
