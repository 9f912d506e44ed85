// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/case_builder/handles.h"

#include <algorithm>
#include <array>
#include <bitset>
#include <queue>

namespace insula::case_builder {
namespace {

using mesh_tool::Field;
using mesh_tool::Grid;

constexpr int link_size = 14;
using Link = std::bitset<link_size>;

struct Step {
  int x, y, z;
};

/// Neighbours in Kuhn's division of a cube, whose diagonals all run along (1, 1, 1).
constexpr std::array<Step, link_size> steps = {{{1, 0, 0},
                                                {0, 1, 0},
                                                {0, 0, 1},
                                                {1, 1, 0},
                                                {1, 0, 1},
                                                {0, 1, 1},
                                                {1, 1, 1},
                                                {-1, 0, 0},
                                                {0, -1, 0},
                                                {0, 0, -1},
                                                {-1, -1, 0},
                                                {-1, 0, -1},
                                                {0, -1, -1},
                                                {-1, -1, -1}}};

/// Which members of a node's link are neighbours of each other: the link is a triangulated sphere.
std::array<Link, link_size> link_edges() {
  std::array<Link, link_size> out;
  for (std::size_t a = 0; a < link_size; ++a)
    for (std::size_t b = 0; b < link_size; ++b)
      for (const Step& s : steps)
        if (steps[a].x + s.x == steps[b].x && steps[a].y + s.y == steps[b].y && steps[a].z + s.z == steps[b].z)
          out[a].set(b);
  return out;
}

bool connected(const Link& set, const std::array<Link, link_size>& edges) {
  if (set.none()) return false;
  Link reached;
  std::size_t first = 0;
  while (!set[first]) ++first;
  reached.set(first);
  for (bool grew = true; grew;) {
    grew = false;
    for (std::size_t k = 0; k < link_size; ++k)
      if (set[k] && !reached[k] && (edges[k] & reached).any()) reached.set(k), grew = true;
  }
  return reached == set;
}

}  // namespace

PartedHandles part_handles(const Grid& grid, Field& inside) {
  static const std::array<Link, link_size> edges = link_edges();
  const auto n0 = std::size_t(grid.size[0]), n1 = std::size_t(grid.size[1]);
  std::array<std::ptrdiff_t, link_size> offset;
  for (std::size_t k = 0; k < link_size; ++k)
    offset[k] = steps[k].x + std::ptrdiff_t(n0) * (steps[k].y + std::ptrdiff_t(n1) * steps[k].z);
  const auto at_border = [&](std::size_t i) {
    const auto x = i % n0, y = i / n0 % n1, z = i / (n0 * n1);
    return x == 0 || y == 0 || z == 0 || x + 1 == n0 || y + 1 == n1 || z + 1 == std::size_t(grid.size[2]);
  };
  std::vector<char> taken(inside.size());
  // The deepest node first; equal ones by their number, so that the result is always the same.
  const auto later = [&](std::size_t a, std::size_t b) {
    return inside[a] != inside[b] ? inside[a] < inside[b] : a > b;
  };
  std::priority_queue<std::size_t, std::vector<std::size_t>, decltype(later)> front(later);
  const auto offer = [&](std::size_t i) {
    for (std::size_t k = 0; k < link_size; ++k) {
      const std::size_t n = std::size_t(std::ptrdiff_t(i) + offset[k]);
      if (!taken[n] && inside[n] > 0 && !at_border(n)) front.push(n);
    }
  };
  const auto deepest = std::size_t(std::max_element(inside.begin(), inside.end()) - inside.begin());
  if (!(inside[deepest] > 0) || at_border(deepest)) return {};
  taken[deepest] = 1;
  offer(deepest);
  while (!front.empty()) {
    const std::size_t i = front.top();
    front.pop();
    if (taken[i]) continue;
    Link inner;
    for (std::size_t k = 0; k < link_size; ++k) inner[k] = taken[std::size_t(std::ptrdiff_t(i) + offset[k])] != 0;
    if (!connected(inner, edges) || !connected(~inner, edges)) continue;  // offered again when a neighbour is taken
    taken[i] = 1;
    offer(i);
  }
  PartedHandles out;
  for (std::size_t i = 0; i < inside.size(); ++i) {
    if (!(inside[i] > 0) || taken[i]) continue;
    if (out.nodes++ == 0) {
      const auto p = grid.point(int(i % n0), int(i / n0 % n1), int(i / (n0 * n1)));
      out.first = Vec3(p[0], p[1], p[2]);
    }
    inside[i] = float(-0.5 * grid.spacing);
  }
  return out;
}

}  // namespace insula::case_builder
