// SPDX-License-Identifier: GPL-3.0-or-later
// Building and refitting the box tree.
#include "core/collision/aabb_tree.h"

#include <algorithm>
#include <numeric>

namespace insula {

void AabbTree::build(std::span<const Vec3> rest, std::span<const std::array<int, 3>> triangles) {
  nodes_.clear();
  leaf_vertices_.clear();
  order_.resize(triangles.size());
  std::iota(order_.begin(), order_.end(), 0);
  if (triangles.empty()) return;
  std::vector<Vec3> centres;
  centres.reserve(triangles.size());
  for (const auto& t : triangles)
    centres.push_back((rest[std::size_t(t[0])] + rest[std::size_t(t[1])] + rest[std::size_t(t[2])]) / 3);
  nodes_.reserve(triangles.size());
  build_node(0, int(triangles.size()), centres, triangles);
  refit(rest, {});
}

int AabbTree::build_node(int first, int count, std::span<const Vec3> centres,
                         std::span<const std::array<int, 3>> triangles) {
  const int me = int(nodes_.size());
  nodes_.emplace_back();
  if (count <= leaf_size) {
    const int start = int(leaf_vertices_.size());
    for (int k = 0; k < count; ++k)
      for (int v : triangles[std::size_t(order_[std::size_t(first + k)])])
        if (std::find(leaf_vertices_.begin() + start, leaf_vertices_.end(), v) == leaf_vertices_.end())
          leaf_vertices_.push_back(v);
    Node& n = nodes_[std::size_t(me)];
    n.first = first;
    n.count = count;
    n.vertices = start;
    n.vertex_count = int(leaf_vertices_.size()) - start;
    n.skip = me + 1;
    return me;
  }
  Aabb box;
  for (int k = 0; k < count; ++k) box.add(centres[std::size_t(order_[std::size_t(first + k)])]);
  int axis = 0;
  (box.high - box.low).maxCoeff(&axis);
  // Equal centres are told apart by their number: the split does not depend on the library's algorithm.
  const auto begin = order_.begin() + first;
  const int half = count / 2;
  std::nth_element(begin, begin + half, begin + count, [&](int a, int b) {
    const double x = centres[std::size_t(a)][axis], y = centres[std::size_t(b)][axis];
    return x != y ? x < y : a < b;
  });
  std::sort(begin, begin + half);
  std::sort(begin + half, begin + count);
  build_node(first, half, centres, triangles);
  const int right = build_node(first + half, count - half, centres, triangles);
  Node& n = nodes_[std::size_t(me)];
  n.first = right;
  n.count = 0;
  n.skip = int(nodes_.size());
  return me;
}

void AabbTree::refit(std::span<const Vec3> positions, std::span<const Vec3> displacements) {
  for (int i = int(nodes_.size()) - 1; i >= 0; --i) {
    Node& n = nodes_[std::size_t(i)];
    if (n.count == 0) {
      n.box = nodes_[std::size_t(i) + 1].box;
      n.box.add(nodes_[std::size_t(n.first)].box);
      continue;
    }
    Aabb box;
    const int* v = leaf_vertices_.data() + n.vertices;
    if (displacements.empty()) {
      for (int k = 0; k < n.vertex_count; ++k) box.add(positions[std::size_t(v[k])]);
    } else {
      for (int k = 0; k < n.vertex_count; ++k) {
        const Vec3& p = positions[std::size_t(v[k])];
        box.add(p);
        box.add(Vec3(p + displacements[std::size_t(v[k])]));
      }
    }
    n.box = box;
  }
}

}  // namespace insula
