// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/base/sorted_pairs.h"

#include <gtest/gtest.h>

#include <random>
#include <set>

namespace insula {
namespace {

TEST(SortedPairs, AreThoseOfASet) {
  std::mt19937 random(5);
  for (int count : {1, 2, 7, 200})
    for (int n : {0, 1, 3, 50, 5000}) {
      std::vector<std::pair<int, int>> pairs;
      std::set<std::pair<int, int>> wanted;
      for (int k = 0; k < n; ++k) {
        const int i = int(random() % unsigned(count)), j = int(random() % unsigned(count));
        pairs.emplace_back(i, j);
        wanted.emplace(std::min(i, j), std::max(i, j));
      }
      sort_unique_pairs(pairs, count);
      EXPECT_EQ(pairs, (std::vector<std::pair<int, int>>(wanted.begin(), wanted.end())));
    }
  std::vector<std::pair<int, int>> none;
  sort_unique_pairs(none, 0);
  EXPECT_TRUE(none.empty());
}

}  // namespace
}  // namespace insula
