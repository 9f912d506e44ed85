// SPDX-License-Identifier: GPL-3.0-or-later
// A static tree of axis-aligned boxes: median splits along the longest side.
#include "core/model/geometry/box_tree.h"

#include <algorithm>
#include <numeric>

namespace insula {

BoxTree::BoxTree(std::vector<Box> items) : boxes_(std::move(items)), order_(boxes_.size()) {
  std::iota(order_.begin(), order_.end(), 0);
  nodes_.reserve(boxes_.size());
  if (!boxes_.empty()) build(0, int(boxes_.size()));
}

int BoxTree::build(int begin, int end) {
  const int me = int(nodes_.size());
  nodes_.emplace_back();
  Box box;
  for (int i = begin; i < end; ++i) box.extend(boxes_[std::size_t(order_[std::size_t(i)])]);
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
    const double ca = boxes_[std::size_t(a)].center()[axis], cb = boxes_[std::size_t(b)].center()[axis];
    return ca != cb ? ca < cb : a < b;
  });
  const int left = build(begin, middle);  // depth is logarithmic: halves
  const int right = build(middle, end);
  nodes_[std::size_t(me)].left = left;
  nodes_[std::size_t(me)].right = right;
  return me;
}

}  // namespace insula
