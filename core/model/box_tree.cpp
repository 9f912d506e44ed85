// SPDX-License-Identifier: GPL-3.0-or-later
// A static tree of axis-aligned boxes: median splits along the longest side.
#include "core/model/box_tree.h"

#include <algorithm>
#include <numeric>

namespace insula {

BoxTree::BoxTree(const std::vector<Box>& items) : order_(items.size()) {
  std::iota(order_.begin(), order_.end(), 0);
  nodes_.reserve(items.size());
  if (!items.empty()) build(items, 0, int(items.size()));
}

int BoxTree::build(const std::vector<Box>& items, int begin, int end) {
  const int me = int(nodes_.size());
  nodes_.emplace_back();
  Box box;
  for (int i = begin; i < end; ++i) box.extend(items[std::size_t(order_[std::size_t(i)])]);
  nodes_[std::size_t(me)].box = box;
  if (end - begin <= 4) {
    nodes_[std::size_t(me)].begin = begin;
    nodes_[std::size_t(me)].end = end;
    return me;
  }
  int axis = 0;
  box.sizes().maxCoeff(&axis);
  const int middle = begin + (end - begin) / 2;
  std::nth_element(order_.begin() + begin, order_.begin() + middle, order_.begin() + end, [&](int a, int b) {
    const double ca = items[std::size_t(a)].center()[axis], cb = items[std::size_t(b)].center()[axis];
    return ca != cb ? ca < cb : a < b;
  });
  const int left = build(items, begin, middle);  // depth is logarithmic: halves
  const int right = build(items, middle, end);
  nodes_[std::size_t(me)].left = left;
  nodes_[std::size_t(me)].right = right;
  return me;
}

}  // namespace insula
