// SPDX-License-Identifier: GPL-3.0-or-later
// Neighbours of a wall's triangles.
#include "plugins/membrane/wall_topology.h"

#include <algorithm>

namespace insula {

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

}  // namespace insula
