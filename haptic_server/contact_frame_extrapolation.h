// SPDX-License-Identifier: GPL-3.0-or-later
// Directions of contact that turn between steps.
//
// A step fixes its normals, but a tool that slides over a lobe, or a lobe that gives way under it, turns them. The
// engine has turned them to where the tool is when the problem arrives, and says by how much each turns while the tool
// goes on by another step's way (Block::turn, core/haptics/contact_frame_prediction.h). Rows turn so about their place
// on the tool, as far as the hand has really gone:
//   d(s) = exp(s turn) d,   moment(s) = arm x d(s)
//   s    = way of the device since the problem's poses, over its way in the step, less the problem's
//   prediction_horizon_steps
#pragma once
#include <array>
#include <vector>

#include "core/constraint/problem.h"
#include "core/haptics/weld_elimination.h"

namespace insula {

/// Allocates in its constructor only.
class ContactFrameExtrapolation {
 public:
  using Jacobian = Eigen::Matrix<double, Eigen::Dynamic, 6, Eigen::RowMajor>;

  explicit ContactFrameExtrapolation(int max_rows);
  /// The next problem. What a tool carries touches by many small faces, whose turning says nothing: its rows stay as
  /// they are.
  void begin(const ConstraintProblem& problem, const std::array<GraspedBody, 2>& grasped) noexcept;
  /// The devices are so far from the problem's poses, tool by tool.
  void extrapolate(const std::array<Vec6, 2>& moved) noexcept;
  /// The first rows of it are those of the problem's tool, as they are now.
  const Jacobian& jacobian(std::size_t tool) const { return jacobian_[tool]; }

 private:
  struct FrameRotation {
    int row;       ///< first of a contact's three
    Vec3 by, arm;  ///< in a step's way, about this place on the tool
  };
  const ConstraintProblem* problem_ = nullptr;
  std::array<Jacobian, 2> jacobian_;
  std::array<std::vector<FrameRotation>, 2> rotations_;
};

}  // namespace insula
