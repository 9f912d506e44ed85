// SPDX-License-Identifier: GPL-3.0-or-later
// Division of a blade into short pieces. Contact uses the corners of a piece and its nearest point. One long blade
// would hold a vessel between its corners at only one point on each side, and the vessel would rock about it.
#pragma once
#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "core/model/tools/tool_model.h"

namespace insula {

/// Appends the piece in slices of about a millimetre across its longest extent. A short piece stays whole.
inline void add_slices(const ConvexPiece& piece, std::vector<ConvexPiece>& out) {
  constexpr double length = 1.2e-3;  // m
  constexpr int corners = 8;         // of a section: 16 for each slice, 24 are allowed
  Vec3 from = Vec3::Zero(), along = Vec3::Zero();
  for (const Vec3& a : piece.points)
    for (const Vec3& b : piece.points)
      if ((b - a).squaredNorm() > along.squaredNorm()) {
        from = a;
        along = b - a;
      }
  const double whole = along.norm();
  const int n = int(std::ceil(whole / length));
  if (n < 2) {
    out.push_back(piece);
    return;
  }
  along /= whole;
  const Vec3 x = along.unitOrthogonal(), y = along.cross(x);
  // The section at s is the hull of the points at which lines between any two points pass s, reduced to its farthest
  // points in a few directions.
  const auto section = [&](double s, std::vector<Vec3>& into) {
    std::vector<Vec3> points;
    for (const Vec3& a : piece.points)
      for (const Vec3& b : piece.points) {
        const double u = along.dot(a - from), v = along.dot(b - from);
        if (std::abs(u - s) < 1e-9) points.push_back(a);
        else if (u < s && v > s) points.push_back(a + (s - u) / (v - u) * (b - a));
      }
    for (int k = 0; k < corners && !points.empty(); ++k) {
      const double angle = 2 * 3.14159265358979323846 * (k + 0.5) / corners;
      const Vec3 d = std::cos(angle) * x + std::sin(angle) * y;
      const Vec3 best = *std::max_element(points.begin(), points.end(),
                                          [&](const Vec3& a, const Vec3& b) { return d.dot(a) < d.dot(b); });
      const bool known = std::any_of(into.begin(), into.end(), [&](const Vec3& p) { return (p - best).norm() < 1e-7; });
      if (!known) into.push_back(best);
    }
  };
  for (int i = 0; i < n; ++i) {
    ConvexPiece slice = piece;
    slice.name += "_" + std::to_string(i + 1);
    slice.points.clear();
    // The ends keep their own points, since a blade's tip is not a flat section.
    section(whole * i / n, slice.points);
    section(whole * (i + 1) / n, slice.points);
    for (const Vec3& p : piece.points) {
      const double s = along.dot(p - from);
      const bool inside = s > whole * i / n + 1e-9 && s < whole * (i + 1) / n - 1e-9;
      if (inside && slice.points.size() < 24) slice.points.push_back(p);
    }
    out.push_back(std::move(slice));
  }
}

}  // namespace insula
