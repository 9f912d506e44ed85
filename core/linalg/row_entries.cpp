// SPDX-License-Identifier: GPL-3.0-or-later
// Rows identified by their entries.
#include "core/linalg/row_entries.h"

#include <algorithm>
#include <cstring>

namespace insula {

void RowEntries::clear() {
  start.assign(1, 0);
  node.clear();
  coeff.clear();
  hash_.clear();
  by_hash_.clear();
}

void RowEntries::take(const BodyRows& rows, const std::vector<int>& node_of_block, const std::vector<int>& permuted) {
  clear();
  for (int r = 0; r < rows.count(); ++r) {
    std::uint64_t h = 0xcbf29ce484222325u;
    const auto mix = [&h](std::uint64_t bits) { h = (h ^ bits ^ (bits >> 32)) * 0x100000001b3u; };
    for (int e = rows.start[std::size_t(r)]; e < rows.start[std::size_t(r) + 1]; ++e) {
      const int n = node_of_block[std::size_t(rows.block[std::size_t(e)])];
      if (n < 0) continue;
      node.push_back(permuted[std::size_t(n)]);
      coeff.push_back(rows.coeff[std::size_t(e)]);
      mix(std::uint64_t(node.back()));
      for (int k = 0; k < 3; ++k) {
        std::uint64_t bits;
        std::memcpy(&bits, &coeff.back()[k], sizeof bits);
        mix(bits);
      }
    }
    start.push_back(int(node.size()));
    hash_.push_back(h);
    by_hash_.emplace_back(h, r);
  }
  std::sort(by_hash_.begin(), by_hash_.end());
}

bool RowEntries::equal(int mine, const RowEntries& other, int r) const {
  const std::size_t a = std::size_t(start[std::size_t(mine)]), b = std::size_t(other.start[std::size_t(r)]);
  const std::size_t n = std::size_t(other.start[std::size_t(r) + 1]) - b;
  if (std::size_t(start[std::size_t(mine) + 1]) - a != n) return false;
  return n == 0 || (std::memcmp(&node[a], &other.node[b], n * sizeof(int)) == 0 &&
                    std::memcmp(coeff[a].data(), other.coeff[b].data(), n * sizeof(Vec3)) == 0);
}

// The same position is tested first, so that equal rows keep their order.
int RowEntries::find(const RowEntries& other, int r) const {
  if (r < count() && equal(r, other, r)) return r;
  const std::uint64_t h = other.hash_[std::size_t(r)];
  for (auto at = std::lower_bound(by_hash_.begin(), by_hash_.end(), std::make_pair(h, 0));
       at != by_hash_.end() && at->first == h; ++at)
    if (equal(at->second, other, r)) return at->second;
  return -1;
}

}  // namespace insula
