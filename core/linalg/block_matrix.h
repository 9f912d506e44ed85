// SPDX-License-Identifier: GPL-3.0-or-later
// Symmetric sparse matrix of 3x3 blocks, lower triangle, one block column a node.
#pragma once
#include <algorithm>
#include <stdexcept>
#include <utility>
#include <vector>

#include "core/base/math.h"

namespace insula {

/// The requested block is not in the pattern.
struct UndeclaredCoupling : std::logic_error {
  UndeclaredCoupling(int i, int j) : std::logic_error("block not in the pattern of the matrix"), row(i), column(j) {}
  int row, column;
};

class BlockMatrix {
 public:
  /// The pattern: pairs of coupled nodes in any order, with repetitions; diagonals are added.
  void set_pattern(int nodes, std::vector<std::pair<int, int>> couplings);

  int nodes() const { return nodes_; }
  int slots() const { return int(row_.size()); }
  int column_start(int j) const { return start_[std::size_t(j)]; }
  int row(int slot) const { return row_[std::size_t(slot)]; }
  /// Slot of block (i, j), i >= j. Throws UndeclaredCoupling when it is not in the pattern.
  int slot(int i, int j) const;
  /// The same; -1 when it is not in the pattern.
  int find_slot(int i, int j) const;
  int diagonal(int j) const { return start_[std::size_t(j)]; }

  void set_zero() { std::fill(value_.begin(), value_.end(), 0.0); }
  double* block(int slot) { return value_.data() + 9 * std::size_t(slot); }  ///< column-major 3x3
  const double* block(int slot) const { return value_.data() + 9 * std::size_t(slot); }
  /// A += scale * other, which must have the same pattern.
  void add_scaled(const BlockMatrix& other, double scale) {
    for (std::size_t k = 0; k < value_.size(); ++k) value_[k] += scale * other.value_[k];
  }
  /// y += A x, both 3 * nodes long.
  void add_product(const double* x, double* y) const;

 private:
  int nodes_ = 0;
  std::vector<int> start_, row_;
  std::vector<double> value_;
};

}  // namespace insula
