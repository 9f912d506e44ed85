// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/linalg/opencl/plan.h"

#include <algorithm>

#include "core/linalg/opencl/device.h"

namespace insula::opencl {
namespace {

constexpr int nodes_of_task = 8;  ///< columns that one group assembles, in nodes

int blocks_of(const FrontRecord& f) { return (f.own + tile - 1) / tile; }

}  // namespace

Plan::Plan(const Elimination& e, const BlockMatrix& a) {
  place(e);
  for (Level& level : levels) {
    add_tasks(level);
    add_blocks(level);
  }
  for (int p = 0; p < e.nodes; ++p) diagonal.push_back(a.diagonal(e.natural[std::size_t(p)]));
  for (std::size_t s = 0; s < e.front.size(); ++s)
    for (int i = e.front[s].scatter_begin; i < e.front[s].scatter_end; ++i) {
      const Elimination::Scatter& from = e.scatter[std::size_t(i)];
      scatter_target.push_back(from.offset);
      scatter.push_back({from.slot, e.front[s].lda, from.transpose ? 1 : 0, 0});
    }
}

/// Records and levels. A level's updates are needed by the next level only, so two memories in turn are enough.
void Plan::place(const Elimination& e) {
  std::vector<int> depth(e.front.size());
  int deepest = -1;
  for (std::size_t s = e.front.size(); s-- > 0;) {  // parents come after their children
    depth[s] = e.front[s].parent < 0 ? 0 : depth[std::size_t(e.front[s].parent)] + 1;
    deepest = std::max(deepest, depth[s]);
  }
  levels.resize(std::size_t(deepest + 1));
  std::vector<record_long> update(levels.size(), 0);
  std::vector<int> carried(levels.size(), 0);
  for (std::size_t s = 0; s < e.front.size(); ++s) {
    const Front& f = e.front[s];
    const std::size_t level = std::size_t(deepest - depth[s]);
    FrontRecord r{};
    r.panel = f.panel;
    r.first = 3 * f.first;
    r.own = 3 * f.own;
    r.rows = 3 * f.rows;
    r.lda = f.lda;
    r.ldu = f.ldu;
    r.map = f.map_begin;
    r.index = f.row_begin;
    r.update = update[level];
    r.carried = carried[level];
    r.inverse = inverse_size;
    r.children_begin = int(children.size());
    children.insert(children.end(), f.children.begin(), f.children.end());
    r.children_end = int(children.size());
    update[level] += record_long(f.ldu) * (r.rows - r.own);
    carried[level] += r.rows - r.own;
    inverse_size += record_long(blocks_of(r)) * tile * tile;
    levels[level].fronts.push_back(int(s));
    fronts.push_back(r);
  }
  for (record_long size : update) update_size = std::max(update_size, size);
  for (int rows : carried) carried_rows = std::max(carried_rows, rows);
}

void Plan::add_tasks(Level& level) {
  const auto range = [this](TaskRange& out, const std::vector<int>& chosen, auto&& add) {
    out.first = int(tasks.size());
    for (int s : chosen) add(s, fronts[std::size_t(s)]);
    out.count = int(tasks.size()) - out.first;
  };
  range(level.all, level.fronts, [this](int s, const FrontRecord&) { tasks.push_back({s}); });
  // A front without children has nothing to add, but its update is cleared all the same.
  range(level.assemble, level.fronts, [this](int s, const FrontRecord& f) {
    if (f.children_begin == f.children_end && f.rows == f.own) return;
    for (int a = 0; a < f.rows / 3; a += nodes_of_task)
      tasks.push_back({s, a, std::min(a + nodes_of_task, f.rows / 3)});
  });
  range(level.subtract, level.fronts, [this](int s, const FrontRecord& f) {
    for (int b = 0; b < f.rows - f.own; b += tile)
      for (int a = b; a < f.rows - f.own; a += tile) tasks.push_back({s, a, b});
  });
}

void Plan::add_blocks(Level& level) {
  int most = 0;
  for (int s : level.fronts) most = std::max(most, blocks_of(fronts[std::size_t(s)]));
  level.blocks.resize(std::size_t(most));
  for (int k = 0; k < most; ++k) {
    Level::Block& block = level.blocks[std::size_t(k)];
    const int begin = k * tile;
    const auto range = [&](TaskRange& out, auto&& add) {
      out.first = int(tasks.size());
      for (int s : level.fronts)
        if (fronts[std::size_t(s)].own > begin) add(s, fronts[std::size_t(s)]);
      out.count = int(tasks.size()) - out.first;
    };
    range(block.update, [&](int s, const FrontRecord& f) {
      for (int row = begin; k > 0 && row < f.rows; row += tile) tasks.push_back({s, begin, row});
    });
    range(block.diagonal, [&](int s, const FrontRecord&) { tasks.push_back({s, begin}); });
    range(block.solve, [&](int s, const FrontRecord& f) {
      for (int row = std::min(begin + tile, f.own); row < f.rows; row += tile) tasks.push_back({s, begin, row});
    });
  }
}

}  // namespace insula::opencl
