// SPDX-License-Identifier: GPL-3.0-or-later
// Construction and refit of the box tree.
#include "core/collision/search/aabb_tree.h"

#include <algorithm>
#include <numeric>

namespace insula {

void AabbTree::build(std::span<const Vec3> rest, std::span<const std::array<int, 3>> triangles) {
  nodes_.clear();
  leaf_vertices_.clear();
  path_boxes_.clear();
  stale_.clear();
  first_leaf_.clear();
  order_.resize(triangles.size());
  std::iota(order_.begin(), order_.end(), 0);
  if (triangles.empty()) return;
  std::vector<Vec3> centres;
  centres.reserve(triangles.size());
  for (const auto& t : triangles)
    centres.push_back((rest[std::size_t(t[0])] + rest[std::size_t(t[1])] + rest[std::size_t(t[2])]) / 3);
  nodes_.reserve(triangles.size());
  build_node(0, int(triangles.size()), centres, triangles);
  list_leaves_of_vertices(rest.size());
  path_boxes_.resize(rest.size());
  stale_.assign(nodes_.size(), 0);
  parent_.assign(nodes_.size(), -1);
  for (std::size_t i = 0; i < nodes_.size(); ++i)
    if (nodes_[i].count == 0) parent_[i + 1] = parent_[std::size_t(nodes_[i].first)] = int(i);
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
  // Equal centres are ordered by their number, so the split does not depend on the library's algorithm.
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

void AabbTree::list_leaves_of_vertices(std::size_t vertices) {
  first_leaf_.assign(vertices + 1, 0);
  for (int v : leaf_vertices_) ++first_leaf_[std::size_t(v) + 1];
  std::partial_sum(first_leaf_.begin(), first_leaf_.end(), first_leaf_.begin());
  leaf_of_.resize(leaf_vertices_.size());
  std::vector<int> at(first_leaf_.begin(), first_leaf_.end() - 1);
  for (std::size_t i = 0; i < nodes_.size(); ++i)
    for (int v : vertices_of(nodes_[i])) leaf_of_[std::size_t(at[std::size_t(v)]++)] = int(i);
}

void AabbTree::mark(std::span<const int> mark_of_vertex) {
  for (std::size_t i = nodes_.size(); i-- > 0;) {
    Node& n = nodes_[i];
    n.marks = 0;
    for (int v : vertices_of(n)) n.marks |= std::uint64_t(1) << mark_of_vertex[std::size_t(v)];
    if (n.count == 0) n.marks = nodes_[i + 1].marks | nodes_[std::size_t(n.first)].marks;
  }
}

Aabb AabbTree::tight(const Node& leaf) const {
  Aabb box;
  for (int v : vertices_of(leaf)) {
    const Vec3& p = positions_[std::size_t(v)];
    box.add(p);
    if (!displacements_.empty()) box.add(Vec3(p + displacements_[std::size_t(v)]));
  }
  return box;
}

void AabbTree::look_at(std::span<const Vec3> positions, std::span<const Vec3> displacements) {
  positions_ = positions;
  displacements_ = displacements;
}

// A vertex that has used half of its slack gets a new box, as one that has left its box.
double AabbTree::renew(std::size_t v) {
  const Vec3& p = positions_[v];
  const Float4 here = rounded(p), there = displacements_.empty() ? here : rounded(p + displacements_[v]);
  OuterBox& box = path_boxes_[v];
  const float inside = box.room_about(here);
  if (inside > 0.5f * slack && box.room_about(there) >= 0) return double(inside);
  box = {here < there ? here : there, here > there ? here : there};
  box.widen();
  box.inflate(slack);
  for (int k = first_leaf_[v]; k < first_leaf_[v + 1]; ++k)
    for (int i = leaf_of_[std::size_t(k)]; i >= 0 && !stale_[std::size_t(i)]; i = parent_[std::size_t(i)])
      stale_[std::size_t(i)] = 1;
  return double(box.room_about(here));
}

double AabbTree::renew(std::span<const int> vertices) {
  double least = 1e30;
  if (nodes_.empty()) return least;
  for (int v : vertices) least = std::min(least, renew(std::size_t(v)));
  return least;
}

void AabbTree::refit(std::span<const Vec3> positions, std::span<const Vec3> displacements) {
  look_at(positions, displacements);
  if (nodes_.empty()) return;
  for (std::size_t v = 0; v < positions.size(); ++v) renew(v);
  close();
}

void AabbTree::close() {
  if (nodes_.empty() || !stale_[0]) return;
  for (std::size_t i = nodes_.size(); i-- > 0;) {
    if (!stale_[i]) continue;
    stale_[i] = 0;
    Node& n = nodes_[i];
    if (n.count == 0) {
      n.box = nodes_[i + 1].box;
      n.box.add(nodes_[std::size_t(n.first)].box);
    } else {
      n.box = {};
      for (int v : vertices_of(n)) n.box.add(path_boxes_[std::size_t(v)]);
    }
  }
}

}  // namespace insula
