// SPDX-License-Identifier: GPL-3.0-or-later
// Elimination of a weld: a rigid body that a tool grasps becomes one body with the tool.
//
// The engine has the grasped body as a body of its own, with a numerical inertia far above its true one. Six weld rows
// J without bounds tie it to the tool. Between steps this has two disadvantages. All contacts of the grasped body act
// through the six stiff rows, which slows the convergence of the sweeps. The inertia acts as a spring to the last
// position (80 N/m at 60 Hz). The rows are therefore eliminated exactly, and the mass becomes the tool's. With H the
// tool's Jacobian, A its matrix, B = W - H A^-1 H^T between the other rows and J (the grasped body alone), and P =
// B_JJ^-1:
//   H'  = H - B P H_J               the contacts of the grasped body are now contacts of the tool
//   A'  = A + H_J^T P H_J           mass over step squared, of both
//   W'  = W - H A^-1 H^T - B P B^T + H' A'^-1 H'^T
//   v   = -H_J^-1 rate_J            of the tool, equal to that of the grasped body
// delta_free, gain and the free pose of the tool change such that forces and poses stay the same for all device poses.
#pragma once
#include <array>

#include "core/constraint/problem.h"

namespace insula {

/// The body that a tool of the problem grasps.
struct GraspedBody {
  bool any = false;
  Vec6 velocity = Vec6::Zero();  ///< of the tool's frame at the end of the step, m/s and rad/s
};

inline constexpr int weld_rows = 6;
/// First of the six rows (BlockRole::weld, one owner) by which the tool grasps a rigid body without other support; -1:
/// none.
int first_weld_row(const ConstraintProblem& problem, std::size_t tool);

/// Allocates only in its constructor.
class WeldElimination {
 public:
  explicit WeldElimination(int max_rows);
  /// The problem without weld rows: `problem` itself if there are none, or else one that is valid until the next call.
  const ConstraintProblem& eliminate(const ConstraintProblem& problem) noexcept;
  const std::array<GraspedBody, 2>& grasped() const { return grasped_; }

 private:
  bool reduce(const ConstraintProblem& from, std::size_t tool, int first, ConstraintProblem& to) noexcept;
  void copy_rest(const ConstraintProblem& from, int first, ConstraintProblem& to) noexcept;

  std::array<ConstraintProblem, 2> reduced_;
  Eigen::Matrix<double, Eigen::Dynamic, 6, Eigen::RowMajor>
      spare_;                             ///< memory of the second tool's Jacobian while there is only one
  std::vector<Vec6> body_, tool_, both_;  ///< by row: B, H, H'
  std::array<GraspedBody, 2> grasped_;
};

}  // namespace insula
