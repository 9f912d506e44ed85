// SPDX-License-Identifier: GPL-3.0-or-later
// A clip in its applier, made one with it.
//
// The engine has the clip as a body of its own, with a numerical inertia far above its own, tied to the applier by six rows J without
// bounds. Between steps that is bad twice: six stiff rows on which everything that the clip touches hangs keep the sweeps from converging,
// and inertia that is asked for its answer over a step is felt as a spring to where the clip was (80 N/m at 60 Hz). So these rows are
// eliminated, exactly, and the clip's mass becomes the tool's. All of it follows from the problem: with H the tool's Jacobian, A its
// matrix, B = W - H A^-1 H^T between the other rows and J (the clip alone), P = B_JJ^-1:
//   H'  = H - B P H_J               what the clip touches is now touched by the tool
//   A'  = A + H_J^T P H_J           mass over step squared, of both
//   W'  = W - H A^-1 H^T - B P B^T + H' A'^-1 H'^T
//   v   = -H_J^-1 rate_J            of the tool, as the clip's
// delta_free, gain and the tool's free pose become such that forces and poses are what they were, wherever the devices go.
#pragma once
#include <array>

#include "core/constraint/problem.h"

namespace insula {

/// What a tool of the problem carries.
struct GraspedBody {
  bool any = false;
  Vec6 velocity = Vec6::Zero();  ///< of the tool's frame at the end of the step, m/s and rad/s
};

inline constexpr int weld_rows = 6;
/// First of the six rows (BlockRole::weld, one owner) by which the tool carries a rigid body that nothing else holds; -1: it carries none.
int first_weld_row(const ConstraintProblem& problem, std::size_t tool);

/// Allocates in its constructor only.
class WeldElimination {
 public:
  explicit WeldElimination(int max_rows);
  /// The problem without such rows: `problem` itself where there are none; else one that stays until the next call.
  const ConstraintProblem& eliminate(const ConstraintProblem& problem) noexcept;
  const std::array<GraspedBody, 2>& grasped() const { return grasped_; }

 private:
  bool reduce(const ConstraintProblem& from, std::size_t tool, int first, ConstraintProblem& to) noexcept;
  void copy_rest(const ConstraintProblem& from, int first, ConstraintProblem& to) noexcept;

  std::array<ConstraintProblem, 2> reduced_;
  Eigen::Matrix<double, Eigen::Dynamic, 6, Eigen::RowMajor> spare_;  ///< memory of the second tool's Jacobian while there is none
  std::vector<Vec6> clip_, tool_, both_;  ///< by row: B, H, H'
  std::array<GraspedBody, 2> grasped_;
};

}  // namespace insula
