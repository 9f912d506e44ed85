// SPDX-License-Identifier: GPL-3.0-or-later
// Surface against surface.
#include "core/collision/tissue_collider.h"

#include <algorithm>
#include <cmath>
#include <map>

#include "core/collision/vertex_groups.h"

namespace insula {

std::vector<int> sample_vertices(std::span<const Vec3> rest, std::span<const std::array<int, 3>> triangles, double distance) {
  std::vector<char> used(rest.size(), 0);
  for (const auto& t : triangles)
    for (int v : t) used[std::size_t(v)] = 1;
  using Cell = std::array<long, 3>;
  std::map<Cell, std::vector<int>> grid;
  std::vector<int> samples;
  for (int v = 0; v < int(rest.size()); ++v) {
    if (!used[std::size_t(v)]) continue;
    const Vec3& p = rest[std::size_t(v)];
    const Cell c{long(std::floor(p[0] / distance)), long(std::floor(p[1] / distance)), long(std::floor(p[2] / distance))};
    bool taken = false;
    for (long i = -1; i <= 1 && !taken; ++i)
      for (long j = -1; j <= 1 && !taken; ++j)
        for (long k = -1; k <= 1 && !taken; ++k) {
          const auto at = grid.find({c[0] + i, c[1] + j, c[2] + k});
          if (at == grid.end()) continue;
          for (int o : at->second) taken = taken || (rest[std::size_t(o)] - p).squaredNorm() < distance * distance;
        }
    if (taken) continue;
    grid[c].push_back(v);
    samples.push_back(v);
  }
  return samples;
}

namespace {

constexpr double horizon = 2e-3;       ///< groups are looked at farther than needed, to know for how long nothing will come, m
constexpr double near_horizon = 5e-4;  ///< and samples

Aabb swept(const CollisionMesh& mesh, int v) {
  Aabb box;
  const Vec3 x = mesh.vertex(v);
  box.add(x);
  box.add(Vec3(x + mesh.free(v)));
  return box;
}

}  // namespace

TissueCollider::TissueCollider(std::vector<int> samples, std::span<const Vec3> rest) : samples_(std::move(samples)) {
  order_by_place(samples_.data(), samples_.data() + samples_.size(), rest, std::ptrdiff_t(group));
  reset();
}

void TissueCollider::reset() {
  behind_.assign(samples_.size(), 1);
  last_.assign(samples_.size(), -1);
  clear_.assign(samples_.size(), 0.0);
  groups_.assign((samples_.size() + group - 1) / group, {});
}

void TissueCollider::detect(const CollisionMesh& a, const CollisionMesh& b, const TissueContactSettings& settings,
                            std::vector<Proximity>& out) {
  if (b.tree().empty()) return;
  const double travelled = a.travelled() + b.travelled(), open_range = settings.alarm + settings.offset;
  const double may_come = open_range + a.farthest_free() + b.farthest_free();
  for (std::size_t first = 0; first < samples_.size(); first += group) {
    const std::size_t last = std::min(first + group, samples_.size());
    // What cannot have come near since it was last looked at needs no look.
    Group& g = groups_[first / group];
    if (!g.deep && g.clear - (travelled - g.travelled) > may_come) continue;
    const double went = travelled - g.travelled;
    g.travelled = travelled;
    if (!g.deep) {
      Aabb here;
      for (std::size_t i = first; i < last; ++i) here.add(a.vertex(samples_[i]));
      here.inflate(may_come + horizon);
      if (!b.tree().any_overlapping(here)) {
        std::fill(clear_.begin() + std::ptrdiff_t(first), clear_.begin() + std::ptrdiff_t(last), may_come + horizon);
        g.clear = may_come + horizon;
        continue;
      }
    }
    for (std::size_t i = first; i < last; ++i) clear_[i] -= went;
    Aabb all;
    bool deep = false;
    for (std::size_t i = first; i < last; ++i) {
      all.add(swept(a, samples_[i]));
      deep = deep || behind_[i] != 0;
    }
    all.inflate(deep ? std::max(open_range, settings.max_depth) : open_range);
    if (!b.tree().any_overlapping(all)) {
      std::fill(behind_.begin() + std::ptrdiff_t(first), behind_.begin() + std::ptrdiff_t(last), char(0));
      g.deep = false;
      g.clear = *std::min_element(clear_.begin() + std::ptrdiff_t(first), clear_.begin() + std::ptrdiff_t(last));
      continue;
    }
    for (std::size_t i = first; i < last; ++i) {
      const int v = samples_[i];
      if (!behind_[i] && clear_[i] > may_come) continue;
      const double range = behind_[i] ? std::max(open_range, settings.max_depth) : open_range;
      behind_[i] = 0;
      Aabb box = swept(a, v);
      box.inflate(range + near_horizon);
      double any2 = (range + near_horizon) * (range + near_horizon);
      const Vec3 x = a.vertex(v), u = a.free(v);
      Vec3 normal = Vec3::Zero();
      double least2 = 1e300;
      int best = -1;
      Vec3 best_bary = Vec3::Zero(), best_point = Vec3::Zero();
      const auto look = [&](int tri, double& limit2) {
        const auto& t = b.triangle(tri);
        const Vec3 p = b.vertex(t[0]), q = b.vertex(t[1]), r = b.vertex(t[2]);
        const Vec3 n = (q - p).cross(r - p);
        const double h = n.dot(x - p), nn = n.squaredNorm();
        if (h * h > limit2 * nn) return;  // its plane is farther than the best
        if (normal.isZero(0)) normal = a.rough_normal(v);
        const Vec3 bary = closest_on_triangle(x, p, q, r);
        const Vec3 c = bary[0] * p + bary[1] * q + bary[2] * r;
        const double d2 = (x - c).squaredNorm();
        any2 = std::min(any2, d2);
        if (normal.dot(n) > -0.25 * std::sqrt(nn)) return;  // faces away
        if (d2 > limit2 || (d2 == limit2 && best >= 0 && tri > best)) return;
        limit2 = d2;
        best = tri;
        best_bary = bary;
        best_point = c;
      };
      // The last step's triangle first: a good bound for the search. It must pass the search's own test of nearness.
      if (const int guess = last_[i]; guess >= 0) {
        Aabb near;
        for (int w : b.triangle(guess)) near.add(swept(b, w));
        if (near.overlaps(box)) look(guess, least2);
      }
      b.tree().nearest(x, &box, least2, look);
      last_[i] = best;
      clear_[i] = std::sqrt(any2);
      if (best < 0) continue;
      const TriangleFeature f = feature_of(best_bary);
      const Vec3 outward = b.pseudo_normal(best, f);
      const Vec3 d = x - best_point;
      const double distance = d.norm();
      const bool outside = d.dot(outward) >= 0;
      // Behind what faces it, but perhaps outside of a fold that does not: the nearest of all tells.
      if (!outside && (distance > settings.max_depth || !b.nearest(x, 0, distance).behind)) continue;
      Proximity c;
      c.vertex = v;
      c.triangle = best;
      c.bary = best_bary;
      c.point = best_point;
      if (distance > 1e-6) {
        if (!b.locally_closest(best, f, d / distance, 0, 0.05)) continue;  // beside a border, or past one that faces away
        c.normal = (outside ? d : Vec3(-d)) / distance;
      } else {
        c.normal = outward;
      }
      c.gap = (outside ? distance : -distance) - settings.offset;
      const double approach = c.normal.dot(u - b.free_at(best, best_bary));
      if (c.gap > settings.alarm && c.gap + approach > settings.alarm) continue;
      behind_[i] = !outside;
      c.start_gap = std::max(c.gap, -settings.max_recovery);
      out.push_back(c);
    }
    g.deep = std::any_of(behind_.begin() + std::ptrdiff_t(first), behind_.begin() + std::ptrdiff_t(last), [](char x) { return x != 0; });
    g.clear = *std::min_element(clear_.begin() + std::ptrdiff_t(first), clear_.begin() + std::ptrdiff_t(last));
  }
}

}  // namespace insula
