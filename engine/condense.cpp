// SPDX-License-Identifier: GPL-3.0-or-later
// Selection of rows for the haptic problem.
#include "engine/condense.h"

#include <algorithm>
#include <cmath>

namespace insula {

void condense(const ConstraintProblem& full, int most_rows, ConstraintProblem& small) {
  if (full.rows <= most_rows) {
    small = full;
    return;
  }
  const std::size_t n = std::size_t(full.rows);
  std::vector<char> felt(n, 0);
  for (const ToolTerms& t : full.tools)
    for (std::size_t r = 0; r < n; ++r)
      if (!t.jacobian.row(long(r)).isZero(0)) felt[r] = 1;
  struct Rank {
    int first, last;  ///< blocks: a patch goes with the contacts it is of
    int rows;
    bool felt;
    double coupling;
  };
  std::vector<Rank> ranks;
  for (std::size_t b = 0; b < full.blocks.size(); ++b) {
    const Block& block = full.blocks[b];
    Rank rank{int(b), int(b), block.rows(), false, 0};
    if (block.law == LawKind::patch) {
      for (int i = 0; i < block.normals; ++i) {
        rank.felt = rank.felt || ranks.back().felt;
        rank.coupling = std::max(rank.coupling, ranks.back().coupling);
        ranks.pop_back();
      }
      rank.first -= block.normals;
      rank.rows += block.normals;
    }
    for (int k = 0; k < block.rows(); ++k) {
      const int r = block.row + k;
      rank.felt = rank.felt || felt[std::size_t(r)];
      // How far the tools' rows would move if this row's force went.
      const double size = std::abs(full.lambda[std::size_t(r)]) + 1e-6;
      for (std::size_t c = 0; c < n; ++c)
        if (felt[c]) rank.coupling = std::max(rank.coupling, size * std::abs(full.w_at(r, int(c))));
    }
    ranks.push_back(rank);
  }
  std::stable_sort(ranks.begin(), ranks.end(), [](const Rank& a, const Rank& b) {
    return a.felt != b.felt ? a.felt : a.coupling > b.coupling;
  });
  std::vector<int> chosen;
  int rows = 0;
  for (const Rank& r : ranks) {
    if (rows + r.rows > most_rows) break;
    rows += r.rows;
    for (int b = r.first; b <= r.last; ++b) chosen.push_back(b);
  }
  std::sort(chosen.begin(), chosen.end());
  small.resize(rows);
  small.step_s = full.step_s;
  small.blocks.clear();
  std::vector<int> source;
  std::vector<char> kept(n, 0);
  for (int b : chosen) {
    Block block = full.blocks[std::size_t(b)];
    for (int k = 0; k < block.rows(); ++k) {
      kept[std::size_t(block.row + k)] = 1;
      source.push_back(block.row + k);
    }
    block.row = int(source.size()) - block.rows();
    small.blocks.push_back(block);
  }
  for (int i = 0; i < rows; ++i) {
    const int s = source[std::size_t(i)];
    double free = full.delta_free[std::size_t(s)];
    for (std::size_t c = 0; c < n; ++c)
      if (!kept[c]) free += full.w_at(s, int(c)) * full.lambda[c];
    small.delta_free[std::size_t(i)] = free;
    small.lambda[std::size_t(i)] = full.lambda[std::size_t(s)];
    small.rate[std::size_t(i)] = full.rate[std::size_t(s)];
    small.relaxation[std::size_t(i)] = full.relaxation[std::size_t(s)];
    for (int j = 0; j < rows; ++j) small.w[std::size_t(i) * std::size_t(small.stride) + std::size_t(j)] = full.w_at(s, source[std::size_t(j)]);
  }
  small.tools = full.tools;
  for (std::size_t t = 0; t < small.tools.size(); ++t) {
    small.tools[t].jacobian.resize(rows, 6);
    for (int i = 0; i < rows; ++i) small.tools[t].jacobian.row(i) = full.tools[t].jacobian.row(source[std::size_t(i)]);
  }
}

}  // namespace insula
