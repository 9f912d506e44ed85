// SPDX-License-Identifier: GPL-3.0-or-later
// Bounding box tree over the triangles of a deforming mesh: built once from the rest shape, refitted every step.
// Nodes lie in depth-first order in one array, so that a refit is one pass from the back. Queries allocate nothing.
#pragma once
#include <array>
#include <span>
#include <vector>

#include "core/base/math.h"

namespace insula {

struct Aabb {
  Vec3 low = Vec3::Constant(1e300);
  Vec3 high = Vec3::Constant(-1e300);

  void add(const Vec3& p) {
    low = low.cwiseMin(p);
    high = high.cwiseMax(p);
  }
  void add(const Aabb& o) {
    low = low.cwiseMin(o.low);
    high = high.cwiseMax(o.high);
  }
  void inflate(double r) {
    low.array() -= r;
    high.array() += r;
  }
  bool overlaps(const Aabb& o) const {
    return low[0] <= o.high[0] && o.low[0] <= high[0] && low[1] <= o.high[1] && o.low[1] <= high[1] &&
           low[2] <= o.high[2] && o.low[2] <= high[2];
  }
  double distance2(const Vec3& p) const {
    double d = 0;
    for (int k = 0; k < 3; ++k) {
      const double x = p[k] < low[k] ? low[k] - p[k] : p[k] > high[k] ? p[k] - high[k] : 0.0;
      d += x * x;
    }
    return d;
  }
};

class AabbTree {
 public:
  static constexpr int leaf_size = 4;  ///< triangles at most in a leaf

  /// Median splits along the longest side; the same input gives the same tree.
  void build(std::span<const Vec3> rest, std::span<const std::array<int, 3>> triangles);
  /// Boxes of the triangles at `positions` joined with those at positions + displacements (may be empty).
  void refit(std::span<const Vec3> positions, std::span<const Vec3> displacements);

  bool empty() const { return nodes_.empty(); }
  const Aabb& bounds() const { return nodes_.front().box; }
  int triangle_count() const { return int(order_.size()); }

  /// visit(triangle) for every triangle of every leaf whose box overlaps `box`.
  template <class Visit>
  void overlapping(const Aabb& box, Visit&& visit) const {
    const int end = int(nodes_.size());
    for (int i = 0; i < end;) {
      const Node& n = nodes_[std::size_t(i)];
      if (!n.box.overlaps(box)) {
        i = n.skip;
        continue;
      }
      for (int k = 0; k < n.count; ++k) visit(order_[std::size_t(n.first + k)]);
      ++i;
    }
  }

  /// Whether any leaf's box overlaps `box`.
  bool any_overlapping(const Aabb& box) const {
    const int end = int(nodes_.size());
    for (int i = 0; i < end;) {
      const Node& n = nodes_[std::size_t(i)];
      if (!n.box.overlaps(box)) i = n.skip;
      else if (n.count > 0) return true;
      else ++i;
    }
    return false;
  }

  /// Branch and bound: visit(triangle, bound2) for triangles of leaves closer to p than sqrt(bound2); the visitor lowers
  /// bound2 as it finds closer ones. Nearer children first.
  template <class Visit>
  void nearest(const Vec3& p, double& bound2, Visit&& visit) const {
    nearest(p, nullptr, bound2, visit);
  }
  /// The same among the leaves whose boxes overlap `within` (null: all).
  template <class Visit>
  void nearest(const Vec3& p, const Aabb* within, double& bound2, Visit&& visit) const {
    if (nodes_.empty()) return;
    struct Open {
      int node;
      double d2;
    };
    std::array<Open, 64> stack;
    int size = 0;
    stack[size++] = {0, nodes_[0].box.distance2(p)};
    while (size > 0) {
      const Open o = stack[--size];
      if (o.d2 > bound2) continue;
      const Node& n = nodes_[std::size_t(o.node)];
      if (within && !n.box.overlaps(*within)) continue;
      if (n.count > 0) {
        for (int k = 0; k < n.count; ++k) visit(order_[std::size_t(n.first + k)], bound2);
        continue;
      }
      const int left = o.node + 1, right = n.first;
      const double dl = nodes_[std::size_t(left)].box.distance2(p), dr = nodes_[std::size_t(right)].box.distance2(p);
      if (dl <= dr) {
        stack[size++] = {right, dr};
        stack[size++] = {left, dl};
      } else {
        stack[size++] = {left, dl};
        stack[size++] = {right, dr};
      }
    }
  }

 private:
  struct Node {
    Aabb box;
    int first = 0;  ///< leaf: first place in order_; inner node: right child (the left one is the next node)
    int count = 0;  ///< triangles, 0 for an inner node
    int skip = 0;   ///< the node after this subtree
    int vertices = 0, vertex_count = 0;  ///< leaf: its vertices in leaf_vertices_
  };
  int build_node(int first, int count, std::span<const Vec3> centres, std::span<const std::array<int, 3>> triangles);

  std::vector<Node> nodes_;
  std::vector<int> order_;          ///< triangles in leaf order
  std::vector<int> leaf_vertices_;  ///< each leaf's vertices, every one once
};

}  // namespace insula
