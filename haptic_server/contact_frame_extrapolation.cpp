// SPDX-License-Identifier: GPL-3.0-or-later
// Finds the contacts to rotate, and rotates their rows.
#include "haptic_server/contact_frame_extrapolation.h"

#include <algorithm>

namespace insula {
namespace {

constexpr double max_share = 1.5;
constexpr double min_swept_displacement_m = 5e-5;  // the hand is at rest: nothing is rotated

Vec3 direction(const ToolTerms& t, int row) { return t.jacobian.row(row).head<3>().transpose(); }

/// Contact point of three orthonormal rows, relative to the tool's origin, m.
Vec3 arm_of(const ToolTerms& t, int row) {
  Vec3 arm = Vec3::Zero();
  for (int k = row; k < row + 3; ++k) arm += 0.5 * direction(t, k).cross(Vec3(t.jacobian.row(k).tail<3>()));
  return arm;
}

}  // namespace

ContactFrameExtrapolation::ContactFrameExtrapolation(int max_rows) {
  for (std::size_t t = 0; t < 2; ++t) {
    jacobian_[t].setZero(max_rows, 6);
    rotations_[t].reserve(std::size_t(max_rows));
  }
}

void ContactFrameExtrapolation::begin(const ConstraintProblem& p, const std::array<GraspedBody, 2>& grasped) noexcept {
  problem_ = &p;
  for (std::size_t t = 0; t < std::min<std::size_t>(p.tools.size(), 2); ++t) {
    const ToolTerms& tool = p.tools[t];
    for (int i = 0; i < p.rows; ++i) jacobian_[t].row(i) = tool.jacobian.row(i);
    rotations_[t].clear();
    for (const Block& b : p.blocks) {
      const Vec3 by(b.frame_rotation[0], b.frame_rotation[1], b.frame_rotation[2]);
      if (b.law == LawKind::friction && !by.isZero(0) && !grasped[t].any && !direction(tool, b.row).isZero(0))
        rotations_[t].push_back({b.row, by, arm_of(tool, b.row)});
    }
  }
}

void ContactFrameExtrapolation::extrapolate(const std::array<Vec6, 2>& moved) noexcept {
  for (std::size_t t = 0; t < std::min<std::size_t>(problem_->tools.size(), 2); ++t) {
    const Vec3& swept_displacement = problem_->tools[t].swept_displacement;
    const double square = swept_displacement.squaredNorm();
    if (square < min_swept_displacement_m * min_swept_displacement_m) continue;
    const double share =
        std::clamp(moved[t].head<3>().dot(swept_displacement) / square - problem_->prediction_horizon_steps, -max_share,
                   max_share);
    for (const FrameRotation& rotation : rotations_[t]) {
      const Vec3 by = share * rotation.by;
      for (int k = rotation.row; k < rotation.row + 3; ++k) {
        Vec3 d = direction(problem_->tools[t], k);
        const double size = d.norm();
        const Vec3 moment = problem_->tools[t].jacobian.row(k).tail<3>().transpose();
        Vec3 rotated = d + by.cross(d) + 0.5 * by.cross(by.cross(d));
        rotated *= size / rotated.norm();
        const Vec3 now = moment + rotation.arm.cross(rotated - d);
        jacobian_[t].row(k) << rotated.transpose(), now.transpose();
      }
    }
  }
}

}  // namespace insula
