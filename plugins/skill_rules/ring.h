// SPDX-License-Identifier: GPL-3.0-or-later
// A ring about a place, as a line of a drawable.
#pragma once
#include <cmath>
#include <numbers>

#include "core/registry/drawable.h"

namespace insula {

inline constexpr int ring_points = 33;

/// A unit vector across n.
inline Vec3 unit_across(const Vec3& n) {
  const Vec3 x = std::abs(n.x()) < 0.9 * n.norm() ? Vec3::UnitX() : Vec3::UnitY();
  return (x - x.dot(n) / n.squaredNorm() * n).normalized();
}

/// A share of a circle about the place, across the normal.
inline void draw_ring(Polylines& line, const Vec3& middle, const Vec3& normal, double radius, double part,
                      double value) {
  const Vec3 n = normal.normalized(), right = unit_across(n), ahead = n.cross(right);
  line.resize(part > 0 ? 1 : 0);
  for (int k = 0; part > 0 && k < ring_points; ++k) {
    const double a = part * 2 * std::numbers::pi * k / (ring_points - 1);
    line.set(0, std::size_t(k), middle + radius * (std::sin(a) * right + std::cos(a) * ahead), value);
  }
}

}  // namespace insula
