// SPDX-License-Identifier: GPL-3.0-or-later
// A rounded piece of a tool at a moment of the step.
#pragma once
#include <array>
#include <span>

#include "core/collision/colliders/tool_collider.h"

namespace insula {

/// A piece at a moment of the step, in the scene frame.
struct PlacedPiece {
  int piece = 0;
  double time = 0;
  Vec3 shift = Vec3::Zero();  // displacement from the free path by sliding, m
  Pose start, pose;           // pose: at `time`, with the shift
  std::array<Vec3, RoundedPiece::max_core> points;
  int count = 0;
  Vec3 axis0, axis1;
  double radius = 0, bound = 0;
  bool expected = false;  ///< at the expected end of the step instead of on the free path

  PlacedPiece(const RoundedPiece& r, int index, const Pose& s, const Vec6& motion, double t, const Vec3& slid,
              double offset)
      : PlacedPiece(r, index, s, t > 0 ? displaced(s, t * motion) : s, t, slid, offset) {}
  /// `there`: the start pose displaced by t of the motion.
  PlacedPiece(const RoundedPiece& r, int index, const Pose& s, const Pose& there, double t, const Vec3& slid,
              double offset)
      : piece(index), time(t), shift(slid), start(s), pose(there) {
    pose.p += slid;
    const Mat3 rotation = pose.q.toRotationMatrix();
    count = int(r.core.size());
    for (int i = 0; i < count; ++i) points[std::size_t(i)] = pose.p + rotation * r.core[std::size_t(i)];
    axis0 = pose.p + rotation * r.axis0;
    axis1 = pose.p + rotation * r.axis1;
    radius = r.radius + offset;
    bound = r.bound;
  }
  std::span<const Vec3> core() const { return {points.data(), std::size_t(count)}; }
};

}  // namespace insula
