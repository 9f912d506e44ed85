// SPDX-License-Identifier: GPL-3.0-or-later
// A static tree of axis-aligned boxes for point queries. The order in which it is built and traversed depends on the
// boxes only.
#pragma once
#include <Eigen/Geometry>
#include <limits>
#include <vector>

#include "core/base/math.h"

namespace insula {

using Box = Eigen::AlignedBox3d;

class BoxTree {
 public:
  explicit BoxTree(std::vector<Box> items);

  /// Calls visit(item) for each item whose box holds p; stops when visit returns true.
  template <class Visit>
  void containing(const Vec3& p, Visit&& visit) const {
    if (nodes_.empty()) return;
    std::vector<int> stack{0};
    while (!stack.empty()) {
      const Node& node = nodes_[std::size_t(stack.back())];
      stack.pop_back();
      if (!node.box.contains(p)) continue;
      if (node.right < 0) {
        for (int i = node.begin; i < node.end; ++i)
          if (boxes_[std::size_t(order_[std::size_t(i)])].contains(p) && visit(order_[std::size_t(i)])) return;
      } else {
        stack.push_back(node.right);
        stack.push_back(node.left);
      }
    }
  }

  /// The item with the smallest squared distance, given by distance2(item). Equal distances give the lowest item. -1
  /// when there are no items.
  template <class Distance2>
  int nearest(const Vec3& p, Distance2&& distance2) const {
    int best = -1;
    double best2 = std::numeric_limits<double>::infinity();
    if (nodes_.empty()) return best;
    std::vector<int> stack{0};
    while (!stack.empty()) {
      const Node& node = nodes_[std::size_t(stack.back())];
      stack.pop_back();
      if (node.box.squaredExteriorDistance(p) > best2) continue;
      if (node.right < 0) {
        for (int i = node.begin; i < node.end; ++i) {
          const int item = order_[std::size_t(i)];
          const double d2 = distance2(item);
          if (d2 < best2 || (d2 == best2 && item < best)) best2 = d2, best = item;
        }
        continue;
      }
      const double l = nodes_[std::size_t(node.left)].box.squaredExteriorDistance(p);
      const double r = nodes_[std::size_t(node.right)].box.squaredExteriorDistance(p);
      stack.push_back(l <= r ? node.right : node.left);  // the nearer child is visited first
      stack.push_back(l <= r ? node.left : node.right);
    }
    return best;
  }

 private:
  struct Node {
    Box box;
    int left = -1, right = -1;  ///< inner nodes
    int begin = 0, end = 0;     ///< items of leaves, in order_
  };
  int build(int begin, int end);

  std::vector<Box> boxes_;
  std::vector<Node> nodes_;
  std::vector<int> order_;
};

}  // namespace insula
