// SPDX-License-Identifier: GPL-3.0-or-later
// Extrapolation of contact directions between steps.
//
// A step fixes its normals, but they rotate when a tool slides over a lobe, or when a lobe yields under it. The engine
// has predicted them for the time at which the problem arrives. It also gives each one's rotation r while the tool
// moves on by its displacement in a step (Block::frame_rotation, core/haptics/contact_frame_prediction.h). Rows are
// rotated about their contact point on the tool, in proportion to the motion of the hand:
//   d(s) = exp(s r) d,   moment(s) = arm x d(s)
//   s    = displacement of the device since the problem's poses, over its displacement in the step, less the problem's
//          prediction_horizon_steps
#pragma once
#include <array>
#include <vector>

#include "core/constraint/problem.h"
#include "core/haptics/weld_elimination.h"

namespace insula {

/// Allocates only in its constructor.
class ContactFrameExtrapolation {
 public:
  using Jacobian = Eigen::Matrix<double, Eigen::Dynamic, 6, Eigen::RowMajor>;

  explicit ContactFrameExtrapolation(int max_rows);
  /// Takes the next problem. A grasped body touches with many small faces, whose rotation means nothing, so its rows
  /// stay as they are.
  void begin(const ConstraintProblem& problem, const std::array<GraspedBody, 2>& grasped) noexcept;
  /// Rotates the rows. `moved`: displacement of each device from the problem's pose, tool by tool.
  void extrapolate(const std::array<Vec6, 2>& moved) noexcept;
  /// Its first rows are the present rows of the problem's tool.
  const Jacobian& jacobian(std::size_t tool) const { return jacobian_[tool]; }

 private:
  struct FrameRotation {
    int row;       ///< first of a contact's three
    Vec3 by, arm;  ///< rotation in a step, rad; from the tool's origin to the contact point, m
  };
  const ConstraintProblem* problem_ = nullptr;
  std::array<Jacobian, 2> jacobian_;
  std::array<std::vector<FrameRotation>, 2> rotations_;
};

}  // namespace insula
