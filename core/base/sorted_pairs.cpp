// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/base/sorted_pairs.h"

#include <algorithm>
#include <cstddef>

namespace insula {

void sort_unique_pairs(std::vector<std::pair<int, int>>& pairs, int count) {
  std::vector<std::size_t> start(std::size_t(count) + 1, 0);
  for (const auto& [i, j] : pairs) ++start[std::size_t(std::min(i, j)) + 1];
  for (std::size_t i = 0; i < std::size_t(count); ++i) start[i + 1] += start[i];
  std::vector<int> larger(pairs.size());
  std::vector<std::size_t> fill(start.begin(), start.end() - 1);
  for (const auto& [i, j] : pairs) larger[fill[std::size_t(std::min(i, j))]++] = std::max(i, j);
  pairs.clear();
  for (int i = 0; i < count; ++i) {
    const auto begin = larger.begin() + std::ptrdiff_t(start[std::size_t(i)]),
               end = larger.begin() + std::ptrdiff_t(start[std::size_t(i) + 1]);
    std::sort(begin, end);
    for (auto at = begin; at != end; ++at)
      if (at == begin || *at != *(at - 1)) pairs.emplace_back(i, *at);
  }
}

}  // namespace insula
