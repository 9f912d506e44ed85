// SPDX-License-Identifier: GPL-3.0-or-later
// Grouping by halving.
#include "core/collision/search/vertex_groups.h"

#include <algorithm>
#include <numeric>

#include "core/collision/search/aabb_tree.h"

namespace insula {

void order_by_position(int* first, int* last, std::span<const Vec3> rest, std::ptrdiff_t group) {
  if (last - first <= group) return;
  Aabb box;
  for (const int* v = first; v != last; ++v) box.add(rest[std::size_t(*v)]);
  int axis = 0;
  (box.high - box.low).maxCoeff(&axis);
  std::sort(first, last, [&](int a, int b) {
    const double x = rest[std::size_t(a)][axis], y = rest[std::size_t(b)][axis];
    return x != y ? x < y : a < b;
  });
  const std::ptrdiff_t groups = (last - first + group - 1) / group;
  int* middle = first + groups / 2 * group;  // whole groups on the left
  order_by_position(first, middle, rest, group);
  order_by_position(middle, last, rest, group);
}

std::vector<int> group_by_position(std::span<const Vec3> rest, int groups) {
  std::vector<int> order(rest.size()), group_of(rest.size());
  std::iota(order.begin(), order.end(), 0);
  const std::ptrdiff_t size = std::max<std::ptrdiff_t>(1, (std::ptrdiff_t(rest.size()) + groups - 1) / groups);
  order_by_position(order.data(), order.data() + order.size(), rest, size);
  for (std::size_t i = 0; i < order.size(); ++i) group_of[std::size_t(order[i])] = int(std::ptrdiff_t(i) / size);
  return group_of;
}

}  // namespace insula
