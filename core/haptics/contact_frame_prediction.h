// SPDX-License-Identifier: GPL-3.0-or-later
// Contacts of tools in the directions they have by the end of the step, and soon after it, for the servo.
//
// A step takes its normals from where tools and surfaces are when it begins. By the time the problem reaches the servo
// they are a step and more behind, and over an edge of the surface that is another normal. The three rows of a contact
// with friction are the three directions of space at one place, so the problem in other directions follows exactly,
// block by block, from a rotation Q of each:
//   H' = Q H,   W' = Q W Q^T,   delta' = Q delta, of contacts that press with the gap as it was,   rate' = Q rate
// and lambda' solves it. The engine's own step is what it was.
//
// How far each will have turned another step later goes with the block, and the servo turns it on as the tool goes.
#pragma once
#include "core/constraint/solve.h"
#include "core/sim/simulation.h"

namespace insula {

/// Turns the three rows of a contact that begin at `row` by q. `delta_m`: of the problem at its lambda; turned
/// likewise.
void rotate_contact_rows(ConstraintProblem& problem, int row, const Mat3& q, std::span<double> delta_m);

class ContactFramePrediction {
 public:
  /// The problem of the simulation's last step, its rows turned to where tools are `ahead_s` after it if they go on as
  /// in it; the simulation's own where nothing presses. Until the next call or step.
  const ConstraintProblem& operator()(const Simulation& simulation, double ahead_s);

 private:
  ConstraintProblem predicted_;
  std::vector<ContactFrame> frames_;
  AlignedVector<double> delta_m_, work_;
  SolveWorkspace workspace_;
};

}  // namespace insula
