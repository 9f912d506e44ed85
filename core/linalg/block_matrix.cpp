// SPDX-License-Identifier: GPL-3.0-or-later
// Pattern and product of the block matrix.
#include "core/linalg/block_matrix.h"

#include "core/base/sorted_pairs.h"
#include "core/linalg/kernels.h"

namespace insula {

void BlockMatrix::set_pattern(int nodes, std::vector<std::pair<int, int>> couplings) {
  nodes_ = nodes;
  for (int i = 0; i < nodes; ++i) couplings.emplace_back(i, i);
  sort_unique_pairs(couplings, nodes);  // (column, row)
  start_.assign(std::size_t(nodes) + 1, 0);
  row_.clear();
  for (auto [column, row] : couplings) {
    ++start_[std::size_t(column) + 1];
    row_.push_back(row);
  }
  for (int j = 0; j < nodes; ++j) start_[std::size_t(j) + 1] += start_[std::size_t(j)];
  value_.assign(9 * row_.size(), 0.0);
}

int BlockMatrix::slot(int i, int j) const {
  const int found = i < 0 || j < 0 || i >= nodes_ || j >= nodes_ ? -1 : find_slot(i, j);
  if (found < 0) throw UndeclaredCoupling(i, j);
  return found;
}

int BlockMatrix::find_slot(int i, int j) const {
  const auto begin = row_.begin() + start_[std::size_t(j)], end = row_.begin() + start_[std::size_t(j) + 1];
  const auto at = std::lower_bound(begin, end, i);
  return at != end && *at == i ? int(at - row_.begin()) : -1;
}

void BlockMatrix::add_product(const double* x, double* y) const {
  block_product()(nodes_, start_.data(), row_.data(), value_.data(), x, y);
}

}  // namespace insula
