// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/collision/search/facing_search.h"

#include <algorithm>
#include <cmath>

namespace insula {
namespace {

bool has_corner(const std::array<int, 3>& triangle, int v) {
  return triangle[0] == v || triangle[1] == v || triangle[2] == v;
}

bool share_corner(const std::array<int, 3>& a, const std::array<int, 3>& b) {
  return has_corner(a, b[0]) || has_corner(a, b[1]) || has_corner(a, b[2]);
}

}  // namespace

void FacingSearch::begin(const CollisionMesh& a, int vertex, const CollisionMesh& b, double reach, double margin) {
  a_ = &a;
  b_ = &b;
  vertex_ = vertex;
  margin_ = margin;
  best_ = -1;
  x_ = a.vertex(vertex);
  normal_.setZero();
  any2_ = least2_ = limit2_ = reach * reach;
}

void FacingSearch::look(int tri, Seen& seen) {
  const auto& t = b_->triangle(tri);
  const Vec3 p = b_->vertex(t[0]), q = b_->vertex(t[1]), r = b_->vertex(t[2]);
  const Vec3 n = (q - p).cross(r - p);
  const double h = n.dot(x_ - p), nn = n.squaredNorm();
  if (h * h > limit2_ * nn) return;  // its plane is too far
  const Vec3 bary = closest_on_triangle(x_, p, q, r);
  const Vec3 c = bary[0] * p + bary[1] * q + bary[2] * r;
  const double d2 = (x_ - c).squaredNorm();
  any2_ = std::min(any2_, d2);
  if (d2 <= limit2_) seen.emplace_back(tri, d2);
  if (d2 > least2_ || (d2 == least2_ && best_ >= 0 && tri > best_)) return;
  if (normal_.isZero(0)) normal_ = a_->rough_normal(vertex_);
  if (normal_.dot(n) > -0.25 * std::sqrt(nn)) return;  // faces away
  least2_ = d2;
  best_ = tri;
  bary_ = bary;
  point_ = c;
  const double enough = std::sqrt(d2) + margin_;
  limit2_ = std::min(limit2_, enough * enough);
}

bool FacingSearch::follow(KnownNearest& known, double sure, Seen& seen) {
  constexpr double rounding = 1e-9;  // m
  seen.clear();
  if (known.triangle < 0) return false;
  look(known.triangle, seen);
  if (best_ < 0) return false;
  const double here = std::sqrt(least2_);
  if (here > sure) return false;
  if (here < known.beside - rounding) return true;
  if (!(here < known.beyond - rounding)) return false;
  const auto& home = b_->triangle(known.home);
  for (int c = 0; c < 3; ++c)
    for (int t : b_->triangles_around(home[std::size_t(c)])) {
      if (t == known.triangle) continue;  // already tested
      if ((c > 0 && has_corner(b_->triangle(t), home[0])) || (c > 1 && has_corner(b_->triangle(t), home[1]))) continue;
      look(t, seen);
    }
  known.triangle = best_;
  known.beside = std::min(known.beyond, std::sqrt(limit2_));
  for (const auto& [t, d2] : seen)
    if (t != best_) known.beside = std::min(known.beside, std::sqrt(d2));
  return true;
}

void FacingSearch::settle(KnownNearest& known, const Seen& seen) const {
  known = {best_, best_, 0, 0};
  if (best_ < 0) return;
  double beside2 = limit2_, beyond2 = limit2_;
  for (const auto& [t, d2] : seen) {
    if (t == best_) continue;
    beside2 = std::min(beside2, d2);
    if (d2 < beyond2 && !share_corner(b_->triangle(t), b_->triangle(best_))) beyond2 = d2;
  }
  known.beside = std::sqrt(beside2);
  known.beyond = std::sqrt(beyond2);
}

}  // namespace insula
