// SPDX-License-Identifier: GPL-3.0-or-later
// Sections of a wall by a plane.
#include "plugins/blood_flow/section.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>

namespace insula {

Vec3 Section::place(const VecX& q, std::size_t corner) const {
  const Corner& c = corners[corner];
  return (1 - c.weight) * q.segment<3>(3 * c.a) + c.weight * q.segment<3>(3 * c.b);
}

Vec3 Section::centre(const VecX& q) const {
  double perimeter = 0;
  Vec3 sum = Vec3::Zero(), last = place(q, corners.size() - 1);
  for (std::size_t i = 0; i < corners.size(); ++i) {
    const Vec3 x = place(q, i);
    const double side = (x - last).norm();
    sum += 0.5 * side * (x + last);
    perimeter += side;
    last = x;
  }
  return perimeter > 0 ? Vec3(sum / perimeter) : last;
}

Lumen Section::wall(const VecX& q) const {
  Lumen out;
  if (corners.size() < 3) return out;
  const Vec3 origin = place(q, 0);
  Vec3 area = Vec3::Zero(), last = Vec3::Zero();
  for (std::size_t i = 1; i <= corners.size(); ++i) {
    const Vec3 x = i < corners.size() ? Vec3(place(q, i) - origin) : Vec3(Vec3::Zero());
    area += last.cross(x);
    out.perimeter += (x - last).norm();
    last = x;
  }
  out.area = 0.5 * area.norm();
  return out;
}

Lumen Section::lumen(const VecX& q, double thickness) const {
  const double half = 0.5 * thickness, turn = std::numbers::pi * half;
  Lumen l = wall(q);
  if (corners.empty()) return l;
  l.area = std::max(0.0, l.area - l.perimeter * half + turn * half);
  l.perimeter = std::max(0.0, l.perimeter - 2 * turn);
  return l;
}

Section cut(const std::vector<Vec3>& nodes, const std::vector<std::array<int, 3>>& triangles, const Vec3& at,
            const Vec3& normal) {
  const Vec3 n = normal.normalized(), u = n.unitOrthogonal(), v = n.cross(u);
  const auto side = [&](int i) {
    const double d = n.dot(nodes[std::size_t(i)] - at);
    return d == 0 ? 1e-15 : d;
  };
  // Goes from crossed edge to crossed edge. The direction in each triangle keeps the upper side on the left.
  using Edge = std::pair<int, int>;
  std::map<Edge, Edge> next;
  for (const auto& t : triangles) {
    Edge in{-1, -1}, out{-1, -1};
    for (std::size_t k = 0; k < 3; ++k) {
      const int a = t[k], b = t[(k + 1) % 3];
      const bool up_a = side(a) > 0, up_b = side(b) > 0;
      if (up_a == up_b) continue;
      (up_a ? out : in) = std::minmax({a, b});
    }
    if (in.first >= 0) next[in] = out;
  }
  Section best;
  double least = 0;
  while (!next.empty()) {
    std::vector<Edge> loop{next.begin()->first};
    bool closed = false;
    for (auto step = next.begin(); step != next.end();) {
      const Edge to = step->second;
      next.erase(step);
      if (to == loop.front()) {
        closed = true;
        break;
      }
      loop.push_back(to);
      step = next.find(to);
    }
    if (!closed || loop.size() < 3) continue;
    Section s;
    double turns = 0, area = 0, x0 = 0, y0 = 0;
    for (std::size_t i = 0; i <= loop.size(); ++i) {
      const Edge& e = loop[i % loop.size()];
      const double da = side(e.first), db = side(e.second), w = da / (da - db);
      const Vec3 p = (1 - w) * nodes[std::size_t(e.first)] + w * nodes[std::size_t(e.second)] - at;
      const double x = u.dot(p), y = v.dot(p);
      if (i > 0) {
        turns += std::atan2(x0 * y - y0 * x, x0 * x + y0 * y);
        area += 0.5 * (x0 * y - y0 * x);
      }
      if (i < loop.size()) s.corners.push_back({e.first, e.second, w});
      x0 = x;
      y0 = y;
    }
    if (std::abs(turns) < std::numbers::pi) continue;  // does not go around
    if (best.corners.empty() || std::abs(area) < least) {
      least = std::abs(area);
      best = std::move(s);
    }
  }
  return best;
}

double resistance_per_length(const Lumen& l, double viscosity) {
  return 2 * viscosity * l.perimeter * l.perimeter / (l.area * l.area * l.area);
}

}  // namespace insula
