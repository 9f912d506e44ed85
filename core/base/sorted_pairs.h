// SPDX-License-Identifier: GPL-3.0-or-later
// Unordered pairs of small numbers, such as the nodes that a force couples. Each pair occurs once, with the smaller
// number first, in ascending order.
#pragma once
#include <utility>
#include <vector>

namespace insula {

/// Both numbers of each pair lie in [0, count). The time is linear except for the pairs that share their smaller
/// number.
void sort_unique_pairs(std::vector<std::pair<int, int>>& pairs, int count);

}  // namespace insula
