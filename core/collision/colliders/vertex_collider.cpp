// SPDX-License-Identifier: GPL-3.0-or-later
// Pieces against vertices.
#include "core/collision/colliders/vertex_collider.h"

#include <algorithm>
#include <cmath>

#include "core/collision/shapes/closest.h"
#include "core/collision/shapes/gjk.h"

namespace insula {

VertexCollider::VertexCollider(const std::vector<ConvexPiece>& pieces, const std::vector<std::array<int, 3>>& triangles,
                               int vertices) {
  for (const ConvexPiece& p : pieces) {
    pieces_.push_back(rounded(p));
    boxes_.emplace_back();
    for (const Vec3& c : pieces_.back().core) boxes_.back().add(c);
  }
  const std::size_t n = std::size_t(vertices);
  triangle_of_.assign(n, {-1, 0});
  for (int t = 0; t < int(triangles.size()); ++t)
    for (int k = 0; k < 3; ++k)
      if (auto& own = triangle_of_[std::size_t(triangles[std::size_t(t)][std::size_t(k)])]; own[0] < 0) own = {t, k};
  seen_.reserve(n);
  near_pieces_.reserve(pieces.size());
  reset();
}

void VertexCollider::reset() {
  kept_out_.assign(triangle_of_.size(), Vec3::Zero());
  marked_.assign(triangle_of_.size(), 0);
  side_.setZero();
}

VertexCollider::Near VertexCollider::nearest(const RoundedPiece& piece, const Pose& pose, const Vec3& x,
                                             double offset) const {
  // In the frame of the pieces, one point is rotated instead of the whole core.
  const Vec3 local = pose.q.conjugate() * (x - pose.p);
  Vec3 core = piece.core[0];
  if (piece.core.size() == 2) {
    const double s = closest_on_segment(local, piece.core[0], piece.core[1]);
    core = piece.core[0] + s * (piece.core[1] - piece.core[0]);
  } else if (piece.core.size() > 2) {
    const std::array<Vec3, 1> point{local};
    core = hull_distance(piece.core, point).a;
  }
  const Vec3 d = core - local;
  const double distance = d.norm();
  return {distance - piece.radius - offset, distance > 1e-7 ? Vec3(pose.q * (d / distance)) : Vec3(Vec3::Zero())};
}

void VertexCollider::detect(const CollisionMesh& mesh, const Pose& start, const Pose& free,
                            const ToolContactSettings& settings, std::vector<Proximity>& out) {
  if (mesh.tree().empty()) return;
  const Vec6 motion = displacement(start, free);
  const double alarm = settings.alarm, turn = motion.tail<3>().norm();
  // Vertices that any piece may approach.
  for (const RoundedPiece& p : pieces_) {
    Aabb box;
    double lever = 0;
    for (const Vec3& c : p.core) {
      box.add(start.apply(c));
      box.add(free.apply(c));
      lever = std::max(lever, c.norm());
    }
    box.inflate(p.radius + settings.offset + alarm + turn * turn * lever);
    mesh.tree().overlapping(box, [&](int t) {
      for (int v : mesh.triangle(t)) {
        if (marked_[std::size_t(v)]) continue;
        marked_[std::size_t(v)] = 1;
        seen_.push_back(v);
      }
    });
  }
  std::sort(seen_.begin(), seen_.end());
  Vec3 pressed = Vec3::Zero();
  const Mat3 to_local = start.q.toRotationMatrix().transpose();

  for (const int v : seen_) {
    marked_[std::size_t(v)] = 0;
    Vec3& memory = kept_out_[std::size_t(v)];
    const Vec3 x0 = mesh.vertex(v), u = mesh.free(v), local = to_local * (x0 - start.p);
    // Vertices that no piece is near to, or comes near to, are skipped.
    const double speed = (motion.head<3>() - u).norm() + turn * (local.norm() + u.norm());
    const double reach = std::max(alarm, 0.2 * alarm + speed);
    near_pieces_.clear();
    for (int i = 0; i < int(pieces_.size()); ++i) {
      const double d =
          std::sqrt(boxes_[std::size_t(i)].distance2(local)) - pieces_[std::size_t(i)].radius - settings.offset;
      if (d <= reach) near_pieces_.push_back({i, d});
    }
    if (near_pieces_.empty()) {
      memory.setZero();
      continue;
    }
    if (settings.one_sided && !side_.isZero(0) && memory.dot(side_) < -0.7) memory = side_.normalized();
    const Vec3 before = start.q * memory;
    int best = -1;
    Near near{1e300, Vec3::Zero()};
    double when = 0;
    for (const auto& [i, at_least] : near_pieces_) {
      if (at_least > std::min(alarm, near.clear)) continue;
      const Near n = nearest(pieces_[std::size_t(i)], start, x0, settings.offset);
      if (n.clear < near.clear) {
        near = n;
        best = i;
      }
    }
    if (near.clear > alarm) {
      memory.setZero();
      // Not near at the start, but perhaps during the motion.
      double first = 1;
      int met = -1;
      Near at_touch{};
      for (const auto& [i, at_least] : near_pieces_) {
        if (at_least > 0.2 * alarm + speed) continue;
        double t = 0;
        for (int k = 0; k < 32 && t < first; ++k) {
          const Pose pose = t > 0 ? displaced(start, t * motion) : start;
          const Near n = nearest(pieces_[std::size_t(i)], pose, x0 + t * u, settings.offset);
          if (n.clear <= 0.2 * alarm) {
            first = t;
            met = i;
            at_touch = n;
            break;
          }
          if (!(speed > 0)) break;
          t += std::max(n.clear, 0.1 * alarm) / speed;
        }
      }
      if (met < 0 || at_touch.normal.isZero(0)) continue;
      best = met;
      near = at_touch;
      when = first;
    } else if (near.normal.isZero(0) || near.normal.dot(before) < -0.2) {
      // A vertex inside the core, or on the piece's other side, is pushed back in the opposite direction.
      if (before.isZero(0)) continue;
      near.clear = -std::abs(near.clear + 2 * (pieces_[std::size_t(best)].radius + settings.offset));
      near.normal = before;
    } else {
      memory = start.q.conjugate() * near.normal;
      // The vertex came from behind: the body wraps around the blade's edge.
      if (settings.one_sided && !side_.isZero(0) && memory.dot(side_) < -0.7) {
        memory = side_.normalized();
        near.clear = -(near.clear + 2 * (pieces_[std::size_t(best)].radius + settings.offset));
        near.normal = start.q * memory;
      }
    }
    if (near.clear < 0.1 * alarm) pressed += memory;
    const auto& own = triangle_of_[std::size_t(v)];
    if (own[0] < 0) continue;
    Proximity c;
    c.piece = best;
    c.vertex = v;
    c.triangle = own[0];
    c.bary[own[1]] = 1;
    c.time = when;
    c.normal = near.normal;
    c.gap = near.clear;
    c.point = x0 + when * u;
    const Pose pose = when > 0 ? displaced(start, when * motion) : start;
    c.local = pose.q.conjugate() * (c.point - pose.p);
    c.start_gap = c.gap;
    if (when > 0) c.start_gap += c.normal.dot(start.apply(c.local) - x0);
    if (when > 0 && c.start_gap < 0) continue;  // it comes from the other side of a moving wall: left to the next step
    c.start_gap = std::max(c.start_gap, -settings.max_correction);
    out.push_back(c);
  }
  seen_.clear();
  // The side from which most vertices press. It is determined when the blade reaches the body, and stays.
  if (side_.norm() < 0.95 && !pressed.isZero(0)) side_ = (0.9 * side_ + 0.1 * pressed.normalized()).eval();
}

}  // namespace insula
