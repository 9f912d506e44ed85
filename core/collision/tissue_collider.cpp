// SPDX-License-Identifier: GPL-3.0-or-later
// Surface against surface.
#include "core/collision/tissue_collider.h"

#include <algorithm>
#include <cmath>
#include <map>

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

TissueCollider::TissueCollider(std::vector<int> samples) : samples_(std::move(samples)) {}

void TissueCollider::detect(const CollisionMesh& a, const CollisionMesh& b, const TissueContactSettings& settings,
                            std::vector<Proximity>& out) const {
  if (b.tree().empty()) return;
  const AabbTree& tree = b.tree();
  for (int v : samples_) {
    const Vec3 x = a.vertex(v);
    const Vec3 u = a.free(v);
    const double radius = settings.alarm + std::min(settings.max_motion, u.norm() + b.largest_displacement());
    double bound2 = radius * radius;
    if (tree.bounds().distance2(x) > bound2) continue;
    bool have_normal = false;
    Vec3 normal = Vec3::Zero();
    int best = -1;
    Vec3 best_bary = Vec3::Zero(), best_point = Vec3::Zero();
    tree.nearest(x, bound2, [&](int tri, double& limit2) {
      const auto& t = b.triangle(tri);
      const Vec3 &p = b.vertex(t[0]), &q = b.vertex(t[1]), &r = b.vertex(t[2]);
      // The triangle's plane is no farther than the triangle.
      const Vec3 n = (q - p).cross(r - p);
      const double h = n.dot(x - p), nn = n.squaredNorm();
      if (h * h > limit2 * nn) return;
      const Vec3 bary = closest_on_triangle(x, p, q, r);
      const Vec3 c = bary[0] * p + bary[1] * q + bary[2] * r;
      const double d2 = (x - c).squaredNorm();
      if (d2 > limit2 || (d2 == limit2 && best >= 0 && tri > best)) return;
      if (!have_normal) {
        normal = a.vertex_normal(v);
        have_normal = true;
      }
      if (normal.dot(n) > -0.25 * std::sqrt(nn)) return;  // faces away
      limit2 = d2;
      best = tri;
      best_bary = bary;
      best_point = c;
    });
    if (best < 0) continue;
    const TriangleFeature f = feature_of(best_bary);
    const Vec3 outward = b.pseudo_normal(best, f);
    const Vec3 d = x - best_point;
    const double distance = d.norm();
    const bool outside = d.dot(outward) >= 0;
    Proximity c;
    c.vertex = v;
    c.triangle = best;
    c.bary = best_bary;
    c.point = best_point;
    if (distance > 1e-6) {
      if (!b.locally_closest(best, f, d / distance, 0, 0.05)) continue;  // beside a border, or seen past one that faces away
      c.normal = (outside ? d : Vec3(-d)) / distance;
    } else {
      c.normal = outward;
    }
    c.gap = outside ? distance : -distance;
    const double approach = c.normal.dot(u - b.free_at(best, best_bary));
    if (c.gap > settings.alarm && c.gap + approach > settings.alarm) continue;
    c.start_gap = std::max(c.gap, -settings.max_recovery);
    out.push_back(c);
  }
}

}  // namespace insula
