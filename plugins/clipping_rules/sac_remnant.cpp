// SPDX-License-Identifier: GPL-3.0-or-later
// Finds the open part of a clipped sac by a breadth-first search over the wall's edges.
#include "plugins/clipping_rules/sac_remnant.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

namespace insula {

bool SacRemnant::attach(const WallModel& wall) {
  const int sac = wall.region("sac"), bleb = wall.region("bleb"), neck = wall.region("neck");
  vertices_.clear();
  if (!(wall.neck_diameter > 0) || sac < 0) return false;
  const Vec3 up = wall.neck_normal, x = up.unitOrthogonal(), y = up.cross(x);
  std::vector<int> own(wall.wall.vertices.size(), -1);
  for (std::size_t i = 0; i < own.size(); ++i) {
    const int r = wall.vertex_region[i];
    if (r != sac && r != neck && (bleb < 0 || r != bleb)) continue;
    own[i] = int(vertices_.size());
    const Vec3 d = wall.wall.vertices[i] - wall.neck_centre;
    const double turn = std::atan2(d.dot(y), d.dot(x)) / (2 * std::numbers::pi) + 0.5;
    vertices_.push_back(
        {int(i), std::min(sectors - 1, int(turn * sectors)), 0, d.dot(up), r == bleb && bleb >= 0, false});
  }
  for (const auto& t : wall.wall.triangles) {
    const Vec3 &a = wall.wall.vertices[std::size_t(t[0])], &b = wall.wall.vertices[std::size_t(t[1])],
               &c = wall.wall.vertices[std::size_t(t[2])];
    for (int v : t)
      if (own[std::size_t(v)] >= 0) vertices_[std::size_t(own[std::size_t(v)])].area += (b - a).cross(c - a).norm() / 6;
  }
  join(wall, own);
  reached_.assign(vertices_.size(), 0);
  front_.assign(vertices_.size(), 0);
  return std::any_of(vertices_.begin(), vertices_.end(), [](const Vertex& v) { return v.height > 0 && v.area > 0; });
}

void SacRemnant::join(const WallModel& wall, std::span<const int> own) {
  edges_.clear();
  for (const auto& t : wall.wall.triangles)
    for (int k = 0; k < 3; ++k) {
      const int a = own[std::size_t(t[std::size_t(k)])], b = own[std::size_t(t[std::size_t((k + 1) % 3)])];
      if (a >= 0 && b < 0) vertices_[std::size_t(a)].border = true;
      if (b >= 0 && a < 0) vertices_[std::size_t(b)].border = true;
      if (a >= 0 && b >= 0) edges_.push_back({std::min(a, b), std::max(a, b)});
    }
  std::sort(edges_.begin(), edges_.end());
  edges_.erase(std::unique(edges_.begin(), edges_.end()), edges_.end());
  first_.assign(vertices_.size() + 1, 0);
  for (const Edge& e : edges_)
    for (const int v : e) ++first_[std::size_t(v) + 1];
  for (std::size_t i = 1; i < first_.size(); ++i) first_[i] += first_[i - 1];
  edge_of_.assign(2 * edges_.size(), 0);
  std::vector<int> next = first_;
  for (std::size_t e = 0; e < edges_.size(); ++e)
    for (const int v : edges_[e]) edge_of_[std::size_t(next[std::size_t(v)]++)] = int(e);
}

SacRemnant::Open SacRemnant::measure(std::span<const char> held, std::span<const char> cut,
                                     std::span<const double> height, double tolerance) const {
  std::fill(reached_.begin(), reached_.end(), char(0));
  std::size_t count = 0;
  for (std::size_t i = 0; i < vertices_.size(); ++i)
    if ((vertices_[i].border || vertices_[i].height <= 0) && !held[i]) {
      reached_[i] = 1;
      front_[count++] = int(i);
    }
  for (std::size_t next = 0; next < count; ++next) {
    const auto i = std::size_t(front_[next]);
    for (int k = first_[i]; k < first_[i + 1]; ++k) {
      const auto e = std::size_t(edge_of_[std::size_t(k)]);
      const int j = edges_[e][0] == int(i) ? edges_[e][1] : edges_[e][0];
      if (cut[e] || reached_[std::size_t(j)] || held[std::size_t(j)]) continue;
      reached_[std::size_t(j)] = 1;
      front_[count++] = j;
    }
  }
  std::array<char, sectors> known{}, open{};
  double area = 0, open_area = 0;
  int bleb = 0, open_bleb = 0;
  for (std::size_t i = 0; i < vertices_.size(); ++i) {
    const Vertex& v = vertices_[i];
    if (v.height <= 0) continue;
    const bool reached = reached_[i];
    area += v.area;
    known[std::size_t(v.sector)] = 1;
    bleb += v.bleb;
    if (!reached) continue;
    open_area += v.area;
    open_bleb += v.bleb;
    if (height[i] > tolerance) open[std::size_t(v.sector)] = 1;
  }
  const auto of = [](const std::array<char, sectors>& flags) {
    return std::count(flags.begin(), flags.end(), char(1));
  };
  return {double(of(open)) / double(std::max<std::ptrdiff_t>(1, of(known))), open_area / area,
          bleb > 0 ? double(open_bleb) / bleb : 0.0};
}

}  // namespace insula
