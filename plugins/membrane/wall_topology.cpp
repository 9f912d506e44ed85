// SPDX-License-Identifier: GPL-3.0-or-later
// Neighbours of a wall's triangles, and what is near along them.
#include "plugins/membrane/wall_topology.h"

#include <fmt/format.h>

#include <algorithm>
#include <limits>

#include "core/base/text.h"
#include "core/model/geometry/triangle_distance.h"
#include "core/params/param.h"

namespace insula {
namespace {

struct Corners {
  Vec3 a, b, c;
  Vec3 middle() const { return (a + b + c) / 3; }
  double distance(const Vec3& p) const { return (p - nearest_on_triangle(p, a, b, c)).norm(); }
};

Corners corners(const WallTopology& wall, const std::vector<Vec3>& nodes, int t) {
  const auto& v = wall.triangles[std::size_t(t)];
  return {nodes[std::size_t(v[0])], nodes[std::size_t(v[1])], nodes[std::size_t(v[2])]};
}

/// Adds the triangles of one spot, from its first one.
void grow(const WallTopology& wall, const std::vector<Vec3>& nodes, const Vec3& spot, double radius, int first,
          std::vector<char>& out) {
  std::vector<char> seen(wall.triangles.size(), 0);
  std::vector<int> front{first};
  seen[std::size_t(first)] = 1;
  while (!front.empty()) {
    const int t = front.back();
    front.pop_back();
    out[std::size_t(t)] = 1;
    for (const int h : wall.hinge_of[std::size_t(t)]) {
      if (h < 0) continue;
      const auto& sides = wall.sides[std::size_t(h)];
      const int next = sides[0].triangle == t ? sides[1].triangle : sides[0].triangle;
      if (seen[std::size_t(next)]) continue;
      seen[std::size_t(next)] = 1;
      if ((corners(wall, nodes, next).middle() - spot).norm() <= radius) front.push_back(next);
    }
  }
}

}  // namespace

std::string WallTopology::build(const std::vector<Vec3>& nodes, const std::vector<std::array<int, 3>>& wall) {
  triangles = wall;
  hinges.clear();
  sides.clear();
  hinge_of.assign(wall.size(), {-1, -1, -1});
  struct Use {
    int low, high, triangle, edge;
  };
  std::vector<Use> uses;
  uses.reserve(3 * wall.size());
  for (std::size_t t = 0; t < wall.size(); ++t) {
    const auto& v = wall[t];
    const Vec3 d = (nodes[std::size_t(v[1])] - nodes[std::size_t(v[0])]),
               e = nodes[std::size_t(v[2])] - nodes[std::size_t(v[0])];
    if (!(d.cross(e).norm() > 1e-6 * std::max(d.squaredNorm(), e.squaredNorm())))
      return "triangle " + std::to_string(t) + " of the wall is flat";
    for (int k = 0; k < 3; ++k) {
      const int a = v[std::size_t(k)], b = v[std::size_t((k + 1) % 3)];
      uses.push_back({std::min(a, b), std::max(a, b), int(t), k});
    }
  }
  std::stable_sort(uses.begin(), uses.end(),
                   [](const Use& a, const Use& b) { return a.low != b.low ? a.low < b.low : a.high < b.high; });
  std::vector<std::array<Side, 2>> found;
  for (std::size_t i = 0, end; i < uses.size(); i = end) {
    end = i + 1;
    while (end < uses.size() && uses[end].low == uses[i].low && uses[end].high == uses[i].high) ++end;
    const std::string edge =
        "the edge between vertices " + std::to_string(uses[i].low) + " and " + std::to_string(uses[i].high);
    if (end - i > 2) return edge + " has " + std::to_string(end - i) + " triangles; a wall has two at most";
    if (end - i == 2)
      found.push_back({Side{uses[i].triangle, uses[i].edge}, Side{uses[i + 1].triangle, uses[i + 1].edge}});
  }
  std::sort(found.begin(), found.end(), [](const auto& a, const auto& b) {
    return a[0].triangle != b[0].triangle ? a[0].triangle < b[0].triangle : a[0].edge < b[0].edge;
  });
  for (const auto& s : found) {
    const auto corner = [&](int side, int k) {
      const Side& at = s[std::size_t(side)];
      return wall[std::size_t(at.triangle)][std::size_t((at.edge + k) % 3)];
    };
    if (corner(0, 0) != corner(1, 1))
      return "triangles " + std::to_string(s[0].triangle) + " and " + std::to_string(s[1].triangle) +
             " of the wall do not agree on which side is out";
    const WallHinge h{{corner(0, 0), corner(0, 1), corner(0, 2), corner(1, 2)}};
    if (h.node[2] == h.node[3])
      return "triangles " + std::to_string(s[0].triangle) + " and " + std::to_string(s[1].triangle) +
             " of the wall are the same";
    for (const Side& at : s) hinge_of[std::size_t(at.triangle)][std::size_t(at.edge)] = int(hinges.size());
    hinges.push_back(h);
    sides.push_back(s);
  }
  return {};
}

std::vector<Vec3> read_spots(std::string_view text, std::string& wrong) {
  std::vector<Vec3> out;
  while (true) {
    const std::size_t end = std::min(text.find(';'), text.size());
    ParamSet alone;
    Param<Vec<Length>> point(&alone, {.name = "spot", .doc = "a point of the wall"});
    wrong = point.assign(trim(text.substr(0, end)), {});
    if (!wrong.empty()) return out;
    out.push_back(point());
    if (end == text.size()) return out;
    text.remove_prefix(end + 1);
  }
}

std::vector<char> spot_triangles(const WallTopology& wall, const std::vector<Vec3>& nodes,
                                 const std::vector<Vec3>& spots, double radius, std::string& wrong) {
  std::vector<char> out(wall.triangles.size(), 0);
  for (std::size_t s = 0; s < spots.size(); ++s) {
    int nearest = -1;
    double least = std::numeric_limits<double>::max();
    for (std::size_t t = 0; t < out.size(); ++t)
      if (const double d = corners(wall, nodes, int(t)).distance(spots[s]); d < least) least = d, nearest = int(t);
    if (least > radius) {
      wrong = fmt::format("point {} is {:.2f} mm from the wall, more than spot_radius; is its unit another one?", s + 1,
                          1e3 * least);
      return out;
    }
    grow(wall, nodes, spots[s], radius, nearest, out);
  }
  return out;
}

}  // namespace insula
