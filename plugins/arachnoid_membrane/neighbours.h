// SPDX-License-Identifier: GPL-3.0-or-later
// Which strands are neighbours: the pairs between which a membrane is spanned.
#pragma once
#include <vector>

#include "plugins/strand_springs/strand_set.h"

namespace insula {

struct StrandPair {
  int first = 0, second = 0;  ///< first < second
  bool crossed = false;       ///< the beginning of one lies beside the end of the other
};

/// Pairs of strands that stand, no farther apart than `span` (m) at either end, without a third strand between them:
/// Gabriel's graph with the sum of the squared distances of both ends. Ascending.
/// Source: K. R. Gabriel, R. R. Sokal, Systematic Zoology 18 (1969) 259.
std::vector<StrandPair> neighbouring_strands(const std::vector<StrandState>& strands, double span);

}  // namespace insula
