// SPDX-License-Identifier: GPL-3.0-or-later
// Bounding box tree over the triangles of a deforming mesh. It is built once from the rest shape and refitted in every
// step. Nodes are in depth-first order in one array, so a refit is one backward pass. Their boxes are in single
// precision, one cache line for each node, four numbers at a time. The boxes are loose. A vertex that stays within
// `slack` of its position at the last box update leaves its boxes unchanged, so the cost of a refit depends on the
// motion. The result of a query does not depend on that history: overlapping() tests the vertices of the leaves it
// reaches. Queries allocate nothing.
#pragma once
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
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

/// Four numbers that are computed at once.
using Float4 = float __attribute__((vector_size(16)));

inline Float4 rounded(const Vec3& p) { return Float4{float(p[0]), float(p[1]), float(p[2]), 0}; }

/// A single-precision box that contains the box it is made of. Coordinates are finite and below 1e30 m.
struct OuterBox {
  Float4 low{1e30f, 1e30f, 1e30f, 0};
  Float4 high{-1e30f, -1e30f, -1e30f, 0};

  static OuterBox around(const Aabb& box) {
    OuterBox r{rounded(box.low), rounded(box.high)};
    r.widen();
    return r;
  }
  /// Adds a margin above the rounding error of the conversion.
  void widen() {
    low -= rounding(low);
    high += rounding(high);
  }
  void inflate(float r) {
    low -= r;
    high += r;
  }
  void add(const OuterBox& o) {
    low = low < o.low ? low : o.low;
    high = high > o.high ? high : o.high;
  }
  /// A lower bound of the distance that the rounded point may move before it leaves the box. If it is negative, the
  /// point may be outside.
  float room_about(Float4 point) const {
    const Float4 below = point - low, above = high - point, m = (below < above ? below : above) - rounding(point);
    return std::min(std::min(m[0], m[1]), m[2]);
  }
  bool overlaps(const OuterBox& o) const {
    const Halves apart = (Halves)((low > o.high) | (o.low > high));
    return (apart[0] | apart[1]) == 0;
  }
  double distance2(const Vec3& p) const { return distance2(Aabb{p, p}); }
  double distance2(const Aabb& o) const {
    double d = 0;
    for (int k = 0; k < 3; ++k) {
      const double x = std::max({double(low[k]) - o.high[k], o.low[k] - double(high[k]), 0.0});
      d += x * x;
    }
    return d;
  }
  static Float4 rounding(Float4 x) { return (x < 0 ? -x : x) * 1.2e-7f + 1e-30f; }
  using Halves = std::int64_t __attribute__((vector_size(16)));
  Aabb box() const { return {Vec3(low[0], low[1], low[2]), Vec3(high[0], high[1], high[2])}; }
};

class AabbTree {
 public:
  static constexpr float slack = 2e-4f;  ///< m
  static constexpr int leaf_size = 4;    ///< triangles at most in a leaf

  /// Median splits along the longest side; the same input gives the same tree.
  void build(std::span<const Vec3> rest, std::span<const std::array<int, 3>> triangles);
  /// Each triangle's box holds the triangle at `positions` and at positions + displacements (which may be empty). The
  /// arrays must exist until the next refit.
  void refit(std::span<const Vec3> positions, std::span<const Vec3> displacements);
  /// The same refit in parts, for a caller that knows which vertices may have left their boxes. look_at() gives the
  /// positions of vertices from now on, renew() takes the vertices to check, and close() ends the refit. renew()
  /// returns the smallest distance of their positions to the sides of their boxes, m. A vertex whose displacement stays
  /// within it needs no renewal.
  void look_at(std::span<const Vec3> positions, std::span<const Vec3> displacements);
  double renew(std::span<const int> vertices);
  void close();

  /// Gives each vertex one of 64 marks, for marks_near().
  void mark(std::span<const int> mark_of_vertex);
  /// The marks, as bits, of all leaves whose loose boxes are within a distance of `box`, axis by axis. Lowers `other`
  /// to the smallest distance of a leaf that has a mark outside of `known`, m.
  std::uint64_t marks_near(const Aabb& box, double within, std::uint64_t known, double& other) const {
    std::uint64_t found = 0;
    Aabb wide = box;
    wide.inflate(within);
    const auto is_other = [&](const Node& n) { return (n.marks & ~known) != 0; };
    const auto has_news = [&](const Node& n) {
      return (n.marks & ~found) != 0 || (is_other(n) && n.box.distance2(box) < other * other);
    };
    each_leaf(wide, has_news, [&](const Node& n) {
      found |= n.marks;
      if (is_other(n)) other = std::min(other, std::sqrt(n.box.distance2(box)));
      return false;
    });
    return found;
  }

  bool empty() const { return nodes_.empty(); }
  Aabb bounds() const { return nodes_.front().box.box(); }
  int triangle_count() const { return int(order_.size()); }

  /// The triangle at a position of the tree's order, and the position where a leaf begins. In this order the triangles
  /// of a leaf are consecutive, and neighbouring leaves are close.
  int triangle_at(int place) const { return order_[std::size_t(place)]; }
  int place_of(std::span<const int> leaf) const { return int(leaf.data() - order_.data()); }

  /// visit(loose box, triangles) for every leaf whose loose box overlaps `box`.
  template <class Visit>
  void leaves(const Aabb& box, Visit&& visit) const {
    each_leaf(box, [&](const Node& n) {
      visit(n.box, triangles_of(n));
      return false;
    });
  }
  /// visit(triangle) for every triangle of every leaf whose vertices' box overlaps `box` and satisfies wanted(that
  /// box).
  template <class Wanted, class Visit>
  void overlapping(const Aabb& box, Wanted&& wanted, Visit&& visit) const {
    each_leaf(box, [&](const Node& n) {
      if (const Aabb leaf = tight(n); leaf.overlaps(box) && wanted(leaf))
        for (int t : triangles_of(n)) visit(t);
      return false;
    });
  }
  template <class Visit>
  void overlapping(const Aabb& box, Visit&& visit) const {
    overlapping(
        box, [](const Aabb&) { return true; }, visit);
  }

  /// Whether any leaf's loose box overlaps `box`.
  bool any_overlapping(const Aabb& box) const {
    return each_leaf(box, [](const Node&) { return true; });
  }

  /// Branch and bound: visit(triangle, bound2) for triangles of leaves closer to p than sqrt(bound2). The visitor
  /// lowers bound2 as it finds closer ones. Nearer children are visited first.
  template <class Visit>
  void nearest(const Vec3& p, double& bound2, Visit&& visit) const {
    nearest(p, nullptr, bound2, visit);
  }
  /// The same, but leaves whose loose boxes do not overlap `within` may be left out (null: none).
  template <class Visit>
  void nearest(const Vec3& p, const Aabb* within, double& bound2, Visit&& visit) const {
    if (nodes_.empty()) return;
    const OuterBox outer = within ? OuterBox::around(*within) : OuterBox{};
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
      if (within && !n.box.overlaps(outer)) continue;
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
    OuterBox box;
    int first = 0;  ///< leaf: first index in order_; inner node: right child (the left child is the next node)
    int count = 0;  ///< triangles, 0 for an inner node
    int skip = 0;   ///< the node after this subtree
    int vertices = 0, vertex_count = 0;  ///< leaf: its vertices in leaf_vertices_
    std::uint64_t marks = 0;             ///< of the vertices below
  };
  int build_node(int first, int count, std::span<const Vec3> centres, std::span<const std::array<int, 3>> triangles);
  void list_leaves_of_vertices(std::size_t vertices);
  std::span<const int> triangles_of(const Node& leaf) const {
    return {order_.data() + leaf.first, std::size_t(leaf.count)};
  }
  std::span<const int> vertices_of(const Node& leaf) const {
    return {leaf_vertices_.data() + leaf.vertices, std::size_t(leaf.vertex_count)};
  }
  Aabb tight(const Node& leaf) const;
  double renew(std::size_t vertex);
  /// visit(leaf) for leaves whose loose box overlaps `box`, until it returns true. Returns whether it did. Subtrees
  /// whose node is not wanted(node) are skipped.
  template <class Wanted, class Visit>
  bool each_leaf(const Aabb& box, Wanted&& wanted, Visit&& visit) const {
    const OuterBox outer = OuterBox::around(box);
    const int end = int(nodes_.size());
    for (int i = 0; i < end;) {
      const Node& n = nodes_[std::size_t(i)];
      if (!wanted(n) || !n.box.overlaps(outer)) {
        i = n.skip;
        continue;
      }
      if (n.count > 0 && visit(n)) return true;
      ++i;
    }
    return false;
  }
  template <class Visit>
  bool each_leaf(const Aabb& box, Visit&& visit) const {
    return each_leaf(
        box, [](const Node&) { return true; }, visit);
  }

  std::vector<Node> nodes_;
  std::vector<int> order_;                 ///< triangles in leaf order
  std::vector<int> leaf_vertices_;         ///< each leaf's vertices, each vertex once
  std::vector<int> first_leaf_, leaf_of_;  ///< each vertex's leaves, as nodes
  std::vector<OuterBox>
      path_boxes_;           ///< of the vertices: loose box of the path from the position to the displaced position
  std::vector<int> parent_;  ///< of the nodes; -1: the root
  std::vector<char> stale_;  ///< nodes whose boxes must be updated, with all their ancestors
  std::span<const Vec3> positions_, displacements_;
};

}  // namespace insula
