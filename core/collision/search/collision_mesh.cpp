// SPDX-License-Identifier: GPL-3.0-or-later
// Adjacency and normals of a collision surface.
#include "core/collision/search/collision_mesh.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <tuple>

#include "core/collision/search/vertex_groups.h"

namespace insula {

void CollisionMesh::build(std::span<const Vec3> rest, std::span<const std::array<int, 3>> triangles) {
  triangles_.assign(triangles.begin(), triangles.end());
  positions_ = rest;
  free_ = {};
  tree_.build(rest, triangles_);
  in_order_.resize(triangles_.size());
  for (std::size_t i = 0; i < triangles_.size(); ++i) in_order_[i] = triangles_[std::size_t(tree_.triangle_at(int(i)))];
  last_.assign(rest.begin(), rest.end());
  travelled_ = farthest_free_ = 0;
  room_.fill(0);
  region_of_ = group_by_position(rest, regions);
  tree_.mark(region_of_);
  region_start_.assign(regions + 1, 0);
  in_region_.resize(rest.size());
  std::iota(in_region_.begin(), in_region_.end(), 0);
  std::stable_sort(in_region_.begin(), in_region_.end(),
                   [this](int a, int b) { return region_of_[std::size_t(a)] < region_of_[std::size_t(b)]; });
  for (int r : region_of_) ++region_start_[std::size_t(r) + 1];
  std::partial_sum(region_start_.begin(), region_start_.end(), region_start_.begin());

  ring_start_.assign(rest.size() + 1, 0);
  for (const auto& t : triangles_)
    for (int v : t) ++ring_start_[std::size_t(v) + 1];
  for (std::size_t v = 0; v < rest.size(); ++v) ring_start_[v + 1] += ring_start_[v];
  ring_.resize(triangles_.size() * 3);
  std::vector<int> fill(ring_start_.begin(), ring_start_.end() - 1);
  for (std::size_t i = 0; i < triangles_.size(); ++i)
    for (int v : triangles_[i]) ring_[std::size_t(fill[std::size_t(v)]++)] = int(i);

  // Neighbours: directed edges sorted by their ends. An edge of more than two triangles joins the first two of opposite
  // sense.
  std::vector<std::tuple<int, int, int>> edges;  // from, to, 3 * triangle + corner
  edges.reserve(triangles_.size() * 3);
  for (std::size_t i = 0; i < triangles_.size(); ++i)
    for (int k = 0; k < 3; ++k)
      edges.emplace_back(triangles_[i][std::size_t(k)], triangles_[i][std::size_t((k + 1) % 3)], int(3 * i) + k);
  std::sort(edges.begin(), edges.end());
  across_.assign(triangles_.size(), {-1, -1, -1});
  for (const auto& [a, b, at] : edges) {
    const auto other = std::lower_bound(edges.begin(), edges.end(), std::make_tuple(b, a, -1));
    if (other != edges.end() && std::get<0>(*other) == b && std::get<1>(*other) == a)
      across_[std::size_t(at / 3)][std::size_t(at % 3)] = std::get<2>(*other) / 3;
  }
}

void CollisionMesh::reserve_few(std::size_t vertices, std::size_t triangles) {
  triangles_.reserve(triangles);
  across_.reserve(triangles);
  ring_start_.reserve(vertices + 1);
  ring_.reserve(3 * triangles);
}

void CollisionMesh::build_few(std::span<const Vec3> positions, std::span<const std::array<int, 3>> triangles,
                              std::span<const Vec3> weighted_normals) {
  triangles_.assign(triangles.begin(), triangles.end());
  positions_ = positions;
  weighted_normals_ = weighted_normals;
  free_ = {};
  ring_start_.assign(positions.size() + 1, 0);
  for (const auto& t : triangles_)
    for (int v : t) ++ring_start_[std::size_t(v) + 1];
  std::partial_sum(ring_start_.begin(), ring_start_.end(), ring_start_.begin());
  ring_.resize(triangles_.size() * 3);
  // Filling moves each start to its end, that is to the next start.
  for (std::size_t i = triangles_.size(); i-- > 0;)
    for (int v : triangles_[i]) ring_[std::size_t(--ring_start_[std::size_t(v) + 1])] = int(i);
  for (std::size_t v = 0; v + 1 < ring_start_.size(); ++v) ring_start_[v] = ring_start_[v + 1];
  ring_start_.back() = int(ring_.size());
  across_.assign(triangles_.size(), {-1, -1, -1});
  for (std::size_t i = 0; i < triangles_.size(); ++i)
    for (std::size_t k = 0; k < 3; ++k) {
      const int from = triangles_[i][k], to = triangles_[i][(k + 1) % 3];
      for (const int other : triangles_around(from)) {
        const auto& t = triangles_[std::size_t(other)];
        for (std::size_t c = 0; c < 3 && across_[i][k] < 0; ++c)
          if (t[c] == to && t[(c + 1) % 3] == from) across_[i][k] = other;
      }
    }
}

void CollisionMesh::keep_positions() {
  if (last_.empty()) last_.assign(positions_.begin(), positions_.end());
}

void CollisionMesh::update(std::span<const Vec3> positions, std::span<const Vec3> free) {
  if (last_.size() != positions.size()) {
    // The earlier positions are unknown. This counts as an additional update, so users of stored distances drop them.
    last_.assign(positions.begin(), positions.end());
    room_.fill(0);
    ++updates_;
  }
  RegionMotion m;
  for (std::size_t v = 0; v < positions.size(); ++v) {
    const std::size_t r = std::size_t(region_of_[v]);
    m.moved[r] = std::max(m.moved[r], (positions[v] - last_[v]).squaredNorm());
    if (!free.empty()) m.may_move[r] = std::max(m.may_move[r], free[v].squaredNorm());
    last_[v] = positions[v];
  }
  for (PerRegion* of : {&m.moved, &m.may_move})
    for (double& x : *of) x = std::sqrt(x);
  take(positions, free, m);
}

void CollisionMesh::update(std::span<const Vec3> positions, std::span<const Vec3> free, const RegionMotion& motion) {
  if (last_.empty()) return take(positions, free, motion);
  update(positions, free);
  last_.clear();
}

void CollisionMesh::take(std::span<const Vec3> positions, std::span<const Vec3> free, const RegionMotion& motion) {
  constexpr double rounding = 1e-9;  // m, more than the rounding error of thousands of sums of motions
  positions_ = positions;
  free_ = free;
  motion_ = motion;
  ++updates_;
  travelled_ += *std::max_element(motion.moved.begin(), motion.moved.end());
  farthest_free_ = *std::max_element(motion.may_move.begin(), motion.may_move.end());
  tree_.look_at(positions, free);
  for (std::size_t r = 0; r < room_.size(); ++r) {
    room_[r] -= motion.moved[r];
    if (room_[r] - motion.may_move[r] > rounding) continue;
    const int first = region_start_[r];
    room_[r] = tree_.renew({in_region_.data() + first, std::size_t(region_start_[r + 1] - first)});
  }
  tree_.close();
}

Vec3 CollisionMesh::face_normal(int tri, double t) const {
  const auto& v = triangle(tri);
  const Vec3 a = vertex(v[0], t);
  const Vec3 n = (vertex(v[1], t) - a).cross(vertex(v[2], t) - a);
  const double l = n.norm();
  return l > 0 ? Vec3(n / l) : Vec3(Vec3::UnitZ());
}

Vec3 CollisionMesh::vertex_normal(int v, double t) const {
  Vec3 sum = Vec3::Zero();
  const Vec3 x = vertex(v, t);
  for (int k = ring_start_[std::size_t(v)]; k < ring_start_[std::size_t(v) + 1]; ++k) {
    const auto& tri = triangle(ring_[std::size_t(k)]);
    const int c = tri[0] == v ? 0 : tri[1] == v ? 1 : 2;
    const Vec3 e = vertex(tri[std::size_t((c + 1) % 3)], t) - x, f = vertex(tri[std::size_t((c + 2) % 3)], t) - x;
    const Vec3 n = e.cross(f);
    const double l = n.norm();
    if (l > 0) sum += n * (std::atan2(l, e.dot(f)) / l);
  }
  const double l = sum.norm();
  return l > 0 ? Vec3(sum / l) : Vec3(Vec3::UnitZ());
}

Vec3 CollisionMesh::weighted_normal(int v, double t) const {
  if (!weighted_normals_.empty()) return weighted_normals_[std::size_t(v)];
  constexpr double smooth = 0.839, sharp = 0.743;  // cosines of 33 and 42 degrees; a tube of six sides has 30
  const Vec3 n = vertex_normal(v, t);
  double least = 1;
  for (const int tri : triangles_around(v)) least = std::min(least, n.dot(face_normal(tri, t)));
  const double x = std::clamp((least - sharp) / (smooth - sharp), 0.0, 1.0);
  return std::sqrt(x * x * (3 - 2 * x)) * n;
}

Vec3 CollisionMesh::rough_normal(int v) const {
  Vec3 sum = Vec3::Zero();
  for (int k = ring_start_[std::size_t(v)]; k < ring_start_[std::size_t(v) + 1]; ++k) {
    const auto& tri = triangle(ring_[std::size_t(k)]);
    const Vec3& a = positions_[std::size_t(tri[0])];
    sum += (positions_[std::size_t(tri[1])] - a).cross(positions_[std::size_t(tri[2])] - a);
  }
  const double l = sum.norm();
  return l > 0 ? Vec3(sum / l) : Vec3(Vec3::UnitZ());
}

Vec3 CollisionMesh::pseudo_normal(int tri, const TriangleFeature& f, double t) const {
  if (f.kind == FeatureKind::vertex) return vertex_normal(triangle(tri)[std::size_t(f.corner)], t);
  const Vec3 n = face_normal(tri, t);
  if (f.kind == FeatureKind::face) return n;
  const int other = across_[std::size_t(tri)][std::size_t(f.corner)];
  if (other < 0) return n;
  const Vec3 sum = n + face_normal(other, t);
  const double l = sum.norm();
  return l > 1e-6 ? Vec3(sum / l) : n;
}

bool CollisionMesh::locally_closest(int tri, const TriangleFeature& f, const Vec3& d, double t, double slack) const {
  if (f.kind == FeatureKind::face) return true;
  if (f.kind == FeatureKind::edge) {
    const int other = across_[std::size_t(tri)][std::size_t(f.corner)];
    if (other < 0) {  // the border of a sheet: only points above it count, not beside it
      return std::abs(d.dot(face_normal(tri, t))) > 0.98;
    }
    const auto& v = triangle(tri);
    const Vec3 along = vertex(v[std::size_t((f.corner + 1) % 3)], t) - vertex(v[std::size_t(f.corner)], t);
    // Into the neighbour: its normal times the edge as the neighbour runs along it (reversed).
    const Vec3 into = face_normal(other, t).cross(-along);
    return d.dot(into) <= slack * into.norm();
  }
  const int v = triangle(tri)[std::size_t(f.corner)];
  const Vec3 x = vertex(v, t);
  for (int k = ring_start_[std::size_t(v)]; k < ring_start_[std::size_t(v) + 1]; ++k) {
    const auto& r = triangle(ring_[std::size_t(k)]);
    const int c = r[0] == v ? 0 : r[1] == v ? 1 : 2;
    const Vec3 e = vertex(r[std::size_t((c + 1) % 3)], t) - x, g = vertex(r[std::size_t((c + 2) % 3)], t) - x;
    if (d.dot(e) > slack * e.norm() || d.dot(g) > slack * g.norm()) return false;
    // Steepest direction inside the triangle, if it lies between its sides.
    const Vec3 n = e.cross(g);
    const double nn = n.squaredNorm();
    if (!(nn > 0)) continue;
    const Vec3 p = d - n * (n.dot(d) / nn);
    if (n.dot(e.cross(p)) > 0 && n.dot(p.cross(g)) > 0 && p.norm() > slack) return false;
    // Beside a border there is no contact.
    if (across_[std::size_t(ring_[std::size_t(k)])][std::size_t(c)] < 0 ||
        across_[std::size_t(ring_[std::size_t(k)])][std::size_t((c + 2) % 3)] < 0) {
      if (std::abs(d.dot(n)) < 0.98 * std::sqrt(nn)) return false;
    }
  }
  return true;
}

NearestPoint CollisionMesh::nearest(const Vec3& p, double t, double limit, const Vec3* side) const {
  NearestPoint e;
  double bound2 = limit * limit * (1 + 1e-9);
  const auto look = [&](int tri, double& least2) {
    if (side && face_normal(tri, t).dot(*side) < 0.2) return;
    const auto& v = triangle(tri);
    const ClosestPair q = point_triangle(p, vertex(v[0], t), vertex(v[1], t), vertex(v[2], t));
    if (q.distance2 > least2 || (q.distance2 == least2 && e.triangle >= 0 && tri > e.triangle)) return;
    least2 = q.distance2;
    e.triangle = tri;
    e.bary = q.bary;
    e.point = q.c;
  };
  if (tree_.empty())
    for (int t = 0; t < triangle_count(); ++t) look(t, bound2);
  else tree_.nearest(p, bound2, look);
  if (e.triangle < 0) return e;
  const Vec3 normal = pseudo_normal(e.triangle, feature_of(e.bary), t);
  const Vec3 d = e.point - p;
  e.distance = d.norm();
  e.behind = d.dot(normal) > 0;
  e.outward = e.distance > 1e-9 ? Vec3((e.behind ? d : Vec3(-d)) / e.distance) : normal;
  return e;
}

}  // namespace insula
