// SPDX-License-Identifier: GPL-3.0-or-later
// The entries of a body's rows in the solver's numbering, and the correspondence of the rows of two sets. Rows are
// identified by their entries, bit by bit, since they have no id here.
#pragma once
#include <cstdint>
#include <utility>
#include <vector>

#include "core/linalg/body_rows.h"

namespace insula {

struct RowEntries {
  std::vector<int> start;  ///< first entry of each row, and the end of the last row
  std::vector<int> node;   ///< permuted; fixed nodes are left out
  std::vector<Vec3> coeff;

  int count() const { return int(start.size()) - 1; }
  void clear();
  void take(const BodyRows& rows, const std::vector<int>& node_of_block, const std::vector<int>& permuted);
  /// The row in this set with the entries of row r of `other`, or -1.
  int find(const RowEntries& other, int r) const;

 private:
  bool equal(int mine, const RowEntries& other, int r) const;
  std::vector<std::uint64_t> hash_;                     ///< of each row
  std::vector<std::pair<std::uint64_t, int>> by_hash_;  ///< sorted
};

}  // namespace insula
