// SPDX-License-Identifier: GPL-3.0-or-later
// Detects whether rows of other components push a body: tissue in the jaws, bone at the shaft.
#pragma once
#include "core/mechanics/constraint.h"

namespace insula {

/// Whether a row that belongs to neither of the components `own` and `other` (document positions) pushes `body` in this
/// step.
inline bool touched_by_others(const Body& body, const ConstraintSolution& solution, int own, int other) {
  std::size_t block = 0;
  const auto& blocks = solution.problem.blocks;
  for (int row : body.rows.row) {
    while (block < blocks.size() && blocks[block].row + blocks[block].rows() <= row) ++block;
    if (block == blocks.size()) return false;
    const int by = blocks[block].owner;
    if (by != own && by != other && solution.lambda[row] != 0) return true;
  }
  return false;
}

}  // namespace insula
