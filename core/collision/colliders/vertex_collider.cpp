// SPDX-License-Identifier: GPL-3.0-or-later
// Pieces against vertices.
#include "core/collision/colliders/vertex_collider.h"

#include <algorithm>
#include <cmath>

#include "core/collision/shapes/closest.h"
#include "core/collision/shapes/gjk.h"

namespace insula {

namespace {
constexpr std::size_t most_edge_points = 2000;  // that the pieces of one link list in a step
}

VertexCollider::VertexCollider(const std::vector<ConvexPiece>& pieces, const std::vector<std::array<int, 3>>& triangles,
                               std::span<const Vec3> rest)
    : edges_(rest, triangles) {
  for (const ConvexPiece& p : pieces) {
    pieces_.push_back(rounded(p));
    boxes_.emplace_back();
    for (const Vec3& c : pieces_.back().core) boxes_.back().add(c);
  }
  const std::size_t n = rest.size();
  triangle_of_.assign(n, {-1, 0});
  for (int t = 0; t < int(triangles.size()); ++t)
    for (int k = 0; k < 3; ++k)
      if (auto& own = triangle_of_[std::size_t(triangles[std::size_t(t)][std::size_t(k)])]; own[0] < 0) own = {t, k};
  const std::size_t most = most_edge_points + 3 * StretchedEdges::per_edge;
  seen_.reserve(n + most);
  seen_triangles_.reserve(triangles.size());
  marked_triangles_.assign(triangles.size(), 0);
  edge_points_.reserve(most);
  kept_points_.reserve(most);
  next_kept_points_.reserve(most);
  near_pieces_.reserve(pieces.size());
  reset();
}

void VertexCollider::reset() {
  kept_out_.assign(triangle_of_.size(), Vec3::Zero());
  marked_.assign(triangle_of_.size(), 0);
  kept_points_.clear();
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

// Lists in seen_ the vertices that any piece may approach, and the points of stretched edges there.
void VertexCollider::list_points(const Step& step) {
  const bool thin_wall = step.settings.offset > 0;
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
      if (marked_triangles_[std::size_t(t)]) return;
      marked_triangles_[std::size_t(t)] = 1;
      seen_triangles_.push_back(t);
      for (int v : step.mesh.triangle(t)) {
        if (marked_[std::size_t(v)]) continue;
        marked_[std::size_t(v)] = 1;
        seen_.push_back(v);
      }
      if (thin_wall && edge_points_.size() < most_edge_points) edges_.append_points(step.mesh, t, edge_points_);
    });
  }
  std::sort(seen_.begin(), seen_.end());
  for (const int v : seen_) marked_[std::size_t(v)] = 0;
  for (const int t : seen_triangles_) marked_triangles_[std::size_t(t)] = 0;
  seen_triangles_.clear();
  std::sort(edge_points_.begin(), edge_points_.end());
  edge_points_.erase(std::unique(edge_points_.begin(), edge_points_.end()), edge_points_.end());
  for (const int p : edge_points_) seen_.push_back(int(triangle_of_.size()) + p);
  edge_points_.clear();
}

VertexCollider::WallPoint VertexCollider::wall_point(const CollisionMesh& mesh, int point) const {
  WallPoint at;
  if (const std::size_t v = std::size_t(point); v < triangle_of_.size()) {
    at.triangle = triangle_of_[v][0];
    at.bary[triangle_of_[v][1]] = 1;
    at.start = mesh.vertex(point);
    at.motion = mesh.free(point);
    return at;
  }
  const auto [triangle, bary] = StretchedEdges::place(point - int(triangle_of_.size()));
  return {triangle, bary, mesh.point(triangle, bary), mesh.free_at(triangle, bary)};
}

// Direction in which a point was kept out in the last step, frame of the pieces; zero: none.
Vec3 VertexCollider::kept_out(int point) const {
  if (std::size_t(point) < kept_out_.size()) return kept_out_[std::size_t(point)];
  const auto at = std::lower_bound(kept_points_.begin(), kept_points_.end(), point,
                                   [](const KeptPoint& k, int wanted) { return k.point < wanted; });
  return at != kept_points_.end() && at->point == point ? at->direction : Vec3(Vec3::Zero());
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

void VertexCollider::add_contact(const Step& step, int point, const WallPoint& at, const Touch& touch,
                                 std::vector<Proximity>& out) {
  if (at.triangle < 0) return;
  Proximity c;
  c.piece = touch.piece;
  c.vertex = point;
  c.triangle = at.triangle;
  c.bary = at.bary;
  c.time = touch.when;
  c.normal = touch.near.normal;
  c.gap = touch.near.clear;
  c.point = at.start + touch.when * at.motion;
  const Pose pose = touch.when > 0 ? displaced(step.start, touch.when * step.motion) : step.start;
  c.local = pose.q.conjugate() * (c.point - pose.p);
  c.start_gap = c.gap;
  if (touch.when > 0) c.start_gap += c.normal.dot(step.start.apply(c.local) - at.start);
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
  list_points(step);
  Vec3 pressed = Vec3::Zero();
  const Mat3 to_local = start.q.toRotationMatrix().transpose();
  next_kept_points_.clear();
  for (const int point : seen_) {
    const WallPoint at = wall_point(mesh, point);
    const Vec3 u = at.motion, local = to_local * (at.start - start.p);
    const double speed = (motion.head<3>() - u).norm() + step.turn * (local.norm() + u.norm());
    const bool vertex = std::size_t(point) < kept_out_.size();
    Vec3 memory = Vec3::Zero();  // points that no piece approaches are skipped
    if (list_pieces(step, local, speed)) {
      memory = kept_out(point);
      if (Touch touch; touch_of(step, at.start, u, speed, memory, touch)) {
        if (vertex && touch.near.clear < 0.1 * settings.alarm) pressed += memory;
        add_contact(step, point, at, touch, out);
      }
    }
    if (vertex) kept_out_[std::size_t(point)] = memory;
    else if (!memory.isZero(0)) next_kept_points_.push_back({point, memory});
  }
  kept_points_.swap(next_kept_points_);
  seen_.clear();
  // The side from which most vertices press. It is determined when the blade reaches the body, and stays.
  if (side_.norm() < 0.95 && !pressed.isZero(0)) side_ = (0.9 * side_ + 0.1 * pressed.normalized()).eval();
}

}  // namespace insula
