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

// Lists in seen_ the vertices that any piece may approach.
void VertexCollider::list_vertices(const Step& step) {
  for (const RoundedPiece& p : pieces_) {
    Aabb box;
    double lever = 0;
    for (const Vec3& c : p.core) {
      box.add(step.start.apply(c));
      box.add(step.free.apply(c));
      lever = std::max(lever, c.norm());
    }
    box.inflate(p.radius + step.settings.offset + step.settings.alarm + step.turn * step.turn * lever);
    step.mesh.tree().overlapping(box, [&](int t) {
      for (int v : step.mesh.triangle(t)) {
        if (marked_[std::size_t(v)]) continue;
        marked_[std::size_t(v)] = 1;
        seen_.push_back(v);
      }
    });
  }
  std::sort(seen_.begin(), seen_.end());
  for (const int v : seen_) marked_[std::size_t(v)] = 0;
}

// Lists in near_pieces_ the pieces that are near a vertex or may come near it. Returns whether there are any.
bool VertexCollider::list_pieces(const Step& step, const Vec3& local, double speed) {
  const double alarm = step.settings.alarm, reach = std::max(alarm, 0.2 * alarm + speed);
  near_pieces_.clear();
  for (int i = 0; i < int(pieces_.size()); ++i) {
    const double d =
        std::sqrt(boxes_[std::size_t(i)].distance2(local)) - pieces_[std::size_t(i)].radius - step.settings.offset;
    if (d <= reach) near_pieces_.push_back({i, d});
  }
  return !near_pieces_.empty();
}

// Finds the nearest piece at the start of the step.
VertexCollider::Touch VertexCollider::nearest_at_start(const Step& step, const Vec3& x0) const {
  Touch best;
  for (const auto& [i, at_least] : near_pieces_) {
    if (at_least > std::min(step.settings.alarm, best.near.clear)) continue;
    const Near n = nearest(pieces_[std::size_t(i)], step.start, x0, step.settings.offset);
    if (n.clear < best.near.clear) {
      best.near = n;
      best.piece = i;
    }
  }
  return best;
}

// Finds the piece that a vertex meets first in the free motion; piece -1 if it meets none.
VertexCollider::Touch VertexCollider::first_contact_on_path(const Step& step, const Vec3& x0, const Vec3& u,
                                                            double speed) const {
  const double alarm = step.settings.alarm;
  Touch first;
  first.when = 1;
  for (const auto& [i, at_least] : near_pieces_) {
    if (at_least > 0.2 * alarm + speed) continue;
    double t = 0;
    for (int k = 0; k < 32 && t < first.when; ++k) {
      const Pose pose = t > 0 ? displaced(step.start, t * step.motion) : step.start;
      const Near n = nearest(pieces_[std::size_t(i)], pose, x0 + t * u, step.settings.offset);
      if (n.clear <= 0.2 * alarm) {
        first = {i, n, t};
        break;
      }
      if (!(speed > 0)) break;
      t += std::max(n.clear, 0.1 * alarm) / speed;
    }
  }
  if (first.near.normal.isZero(0)) first.piece = -1;
  return first;
}

// Finds the contact of a vertex, and updates the side that the vertex remembers. False if no piece pushes it.
bool VertexCollider::touch_of(const Step& step, const Vec3& x0, const Vec3& u, double speed, Vec3& memory,
                              Touch& touch) const {
  const bool one_sided = step.settings.one_sided && !side_.isZero(0);
  if (one_sided && memory.dot(side_) < -0.7) memory = side_.normalized();
  const Vec3 before = step.start.q * memory;
  touch = nearest_at_start(step, x0);
  if (touch.near.clear > step.settings.alarm) {
    memory.setZero();
    touch = first_contact_on_path(step, x0, u, speed);  // not near at the start, but perhaps during the motion
    return touch.piece >= 0;
  }
  Near& near = touch.near;
  const double through = 2 * (pieces_[std::size_t(touch.piece)].radius + step.settings.offset);
  if (near.normal.isZero(0) || near.normal.dot(before) < -0.2) {
    // A vertex inside the core, or on the piece's other side, is pushed back in the opposite direction.
    if (before.isZero(0)) return false;
    near.clear = -std::abs(near.clear + through);
    near.normal = before;
    return true;
  }
  memory = step.start.q.conjugate() * near.normal;
  // The vertex came from behind: the body wraps around the blade's edge.
  if (one_sided && memory.dot(side_) < -0.7) {
    memory = side_.normalized();
    near.clear = -(near.clear + through);
    near.normal = step.start.q * memory;
  }
  return true;
}

void VertexCollider::add_contact(const Step& step, int v, const Touch& touch, std::vector<Proximity>& out) const {
  const auto& own = triangle_of_[std::size_t(v)];
  if (own[0] < 0) return;
  const Vec3 x0 = step.mesh.vertex(v);
  Proximity c;
  c.piece = touch.piece;
  c.vertex = v;
  c.triangle = own[0];
  c.bary[own[1]] = 1;
  c.time = touch.when;
  c.normal = touch.near.normal;
  c.gap = touch.near.clear;
  c.point = x0 + touch.when * step.mesh.free(v);
  const Pose pose = touch.when > 0 ? displaced(step.start, touch.when * step.motion) : step.start;
  c.local = pose.q.conjugate() * (c.point - pose.p);
  c.start_gap = c.gap;
  if (touch.when > 0) c.start_gap += c.normal.dot(step.start.apply(c.local) - x0);
  // A vertex that comes from the other side of a moving wall is left to the next step.
  if (touch.when > 0 && c.start_gap < 0) return;
  c.start_gap = std::max(c.start_gap, -step.settings.max_correction);
  out.push_back(c);
}

void VertexCollider::detect(const CollisionMesh& mesh, const Pose& start, const Pose& free,
                            const ToolContactSettings& settings, std::vector<Proximity>& out) {
  if (mesh.tree().empty()) return;
  const Vec6 motion = displacement(start, free);
  const Step step{mesh, start, free, settings, motion, motion.tail<3>().norm()};
  list_vertices(step);
  Vec3 pressed = Vec3::Zero();
  const Mat3 to_local = start.q.toRotationMatrix().transpose();
  for (const int v : seen_) {
    Vec3& memory = kept_out_[std::size_t(v)];
    const Vec3 x0 = mesh.vertex(v), u = mesh.free(v), local = to_local * (x0 - start.p);
    const double speed = (motion.head<3>() - u).norm() + step.turn * (local.norm() + u.norm());
    if (!list_pieces(step, local, speed)) {
      memory.setZero();  // vertices that no piece approaches are skipped
      continue;
    }
    Touch touch;
    if (!touch_of(step, x0, u, speed, memory, touch)) continue;
    if (touch.near.clear < 0.1 * settings.alarm) pressed += memory;
    add_contact(step, v, touch, out);
  }
  seen_.clear();
  // The side from which most vertices press. It is determined when the blade reaches the body, and stays.
  if (side_.norm() < 0.95 && !pressed.isZero(0)) side_ = (0.9 * side_ + 0.1 * pressed.normalized()).eval();
}

}  // namespace insula
