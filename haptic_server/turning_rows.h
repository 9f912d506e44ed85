// SPDX-License-Identifier: GPL-3.0-or-later
// Directions of contact that turn between steps.
//
// A step fixes its normals, but a tool that slides over a lobe, or a lobe that gives way under it, turns them: the force's direction lags
// behind by a step and more. How a row has turned from the last problem to this one is known by its block's id; it is taken to go on
// turning so as the tool goes on moving as it did. Rows turn about their place on the tool:
//   d(s) = exp(s w) d,   w = n_last x n_now,   moment(s) = arm x d(s)
//   s    = way of the device since the problem, over its way from the last problem to this one
#pragma once
#include <array>
#include <cstdint>
#include <vector>

#include "core/constraint/problem.h"
#include "haptic_server/carried.h"

namespace insula {

/// Allocates in its constructor only.
class TurningRows {
 public:
  using Jacobian = Eigen::Matrix<double, Eigen::Dynamic, 6, Eigen::RowMajor>;

  explicit TurningRows(int most_rows);
  /// The next problem. What a tool carries touches by many small faces, whose turning says nothing: its rows stay as they are.
  void begin(const ConstraintProblem& problem, const std::array<Load, 2>& loads) noexcept;
  /// The devices are so far from the problem's poses, tool by tool.
  void turn(const std::array<Vec6, 2>& moved) noexcept;
  void forget() noexcept { last_count_ = 0; }
  /// The first rows of it are those of the problem's tool, as they are now.
  const Jacobian& jacobian(std::size_t tool) const { return jacobian_[tool]; }

 private:
  struct Direction {
    std::uint64_t id;
    Vec3 normal;
  };
  struct Turn {
    int row, rows;
    Vec3 by, arm;  ///< about this place on the tool, from the last problem to this one
  };
  const ConstraintProblem* problem_ = nullptr;
  std::array<Jacobian, 2> jacobian_;
  std::array<std::vector<Turn>, 2> turns_;
  std::array<std::vector<Direction>, 2> last_;  ///< of the last problem, by id
  std::vector<Direction> next_;                 ///< of this one, while they are compared
  std::array<Pose, 2> device_;
  std::array<int, 2> hand_{-1, -1};
  std::array<Vec3, 2> way_{Vec3::Zero(), Vec3::Zero()};
  std::size_t last_count_ = 0;
};

}  // namespace insula
