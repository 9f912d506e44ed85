// SPDX-License-Identifier: GPL-3.0-or-later
// The part of the sparse constraint Jacobian H that belongs to one body, row by row.
#pragma once
#include <vector>

#include "core/base/math.h"

namespace insula {

struct BodyRows {
  std::vector<int> row;     ///< number of each stored row in the whole problem, ascending
  std::vector<int> start;   ///< first entry of each stored row, and the end of the last row
  std::vector<int> block;   ///< 3-block of degrees of freedom of each entry
  std::vector<Vec3> coeff;  ///< entry: derivative of the row with respect to that block

  int count() const { return int(row.size()); }
  void clear() {
    row.clear();
    start.assign(1, 0);
    block.clear();
    coeff.clear();
  }
  /// Opens row r, unless it is already the last one. Rows come in ascending order.
  void open(int r) {
    if (!row.empty() && row.back() == r) return;
    row.push_back(r);
    start.push_back(int(block.size()));
  }
  void add(int b, const Vec3& c) {
    block.push_back(b);
    coeff.push_back(c);
    start.back() = int(block.size());
  }
};

}  // namespace insula
