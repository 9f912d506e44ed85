// SPDX-License-Identifier: GPL-3.0-or-later
// Ordering, fronts and memory of the direct solver.
#include "core/linalg/elimination.h"

#include <cholmod.h>

#include <algorithm>
#include <stdexcept>

namespace insula {
namespace {

struct Supernodes {
  std::vector<int> permutation, super, row_start, row;
};

Supernodes analyse_graph(const BlockMatrix& a) {
  cholmod_common c;
  cholmod_start(&c);
  c.print = 0;
  c.supernodal = CHOLMOD_SUPERNODAL;
  c.nmethods = 1;
  c.method[0].ordering = a.nodes() > 4000 ? CHOLMOD_METIS : CHOLMOD_AMD;
  c.postorder = 1;
  // Larger supernodes than the defaults: a node stands for three scalar columns.
  c.nrelax[0] = 4;
  c.nrelax[1] = 12;
  c.nrelax[2] = 32;
  c.zrelax[0] = 0.9;
  c.zrelax[1] = 0.3;
  c.zrelax[2] = 0.08;
  const std::size_t n = std::size_t(a.nodes());
  cholmod_sparse* g = cholmod_allocate_sparse(n, n, std::size_t(a.slots()), 1, 1, -1, CHOLMOD_PATTERN, &c);
  Supernodes out;
  cholmod_factor* f = nullptr;
  if (g) {
    int* p = static_cast<int*>(g->p);
    int* i = static_cast<int*>(g->i);
    for (int j = 0; j <= a.nodes(); ++j) p[j] = j < a.nodes() ? a.column_start(j) : a.slots();
    for (int s = 0; s < a.slots(); ++s) i[s] = a.row(s);
    f = cholmod_analyze(g, &c);
  }
  if (f && f->is_super) {
    const int* perm = static_cast<const int*>(f->Perm);
    const int* super = static_cast<const int*>(f->super);
    const int* pi = static_cast<const int*>(f->pi);
    const int* s = static_cast<const int*>(f->s);
    out.permutation.assign(perm, perm + n);
    out.super.assign(super, super + f->nsuper + 1);
    out.row_start.assign(pi, pi + f->nsuper + 1);
    out.row.assign(s, s + f->ssize);
  }
  if (f) cholmod_free_factor(&f, &c);
  if (g) cholmod_free_sparse(&g, &c);
  cholmod_finish(&c);
  if (out.super.empty()) throw std::runtime_error("symbolic factorisation failed");
  return out;
}

}  // namespace

void Elimination::analyse(const BlockMatrix& a, int lanes) {
  const auto pad = [lanes](int n) { return (n + lanes - 1) & -lanes; };
  nodes = a.nodes();
  front.clear();
  scatter.clear();
  map.clear();
  entries = 0;
  flops = 0;
  panel_size = arena_size = 0;
  if (nodes == 0) return;
  const Supernodes sn = analyse_graph(a);
  natural = sn.permutation;
  permuted.assign(std::size_t(nodes), 0);
  for (int p = 0; p < nodes; ++p) permuted[std::size_t(natural[std::size_t(p)])] = p;
  row_node = sn.row;
  row_scalar.resize(3 * row_node.size());
  for (std::size_t r = 0; r < row_node.size(); ++r)
    for (int k = 0; k < 3; ++k) row_scalar[3 * r + std::size_t(k)] = 3 * row_node[r] + k;

  const int count = int(sn.super.size()) - 1;
  front.resize(std::size_t(count));
  front_of.assign(std::size_t(nodes), 0);
  long panel = 0;
  for (int s = 0; s < count; ++s) {
    Front& f = front[std::size_t(s)];
    f.first = sn.super[std::size_t(s)];
    f.own = sn.super[std::size_t(s) + 1] - f.first;
    f.row_begin = sn.row_start[std::size_t(s)];
    f.rows = sn.row_start[std::size_t(s) + 1] - f.row_begin;
    f.lda = pad(3 * f.rows);
    f.panel = panel;
    panel += long(f.lda) * 3 * f.own;
    for (int k = 0; k < f.own; ++k) front_of[std::size_t(f.first + k)] = s;
    const double n = 3.0 * f.own, m = 3.0 * f.rows;
    entries += std::int64_t(n * m - n * (n - 1) / 2);
    flops += n * n * n / 3 + n * n * (m - n) + n * (m - n) * (m - n);
  }
  // Parents, and the positions of a child's rows in its parent.
  for (int s = 0; s < count; ++s) {
    Front& f = front[std::size_t(s)];
    if (f.rows == f.own) continue;
    f.parent = front_of[std::size_t(row_node[std::size_t(f.row_begin + f.own)])];
    Front& p = front[std::size_t(f.parent)];
    p.children.push_back(s);
    f.map_begin = int(map.size());
    int at = 0;
    for (int r = f.own; r < f.rows; ++r) {
      const int node = row_node[std::size_t(f.row_begin + r)];
      while (row_node[std::size_t(p.row_begin + at)] != node) ++at;
      map.push_back(at);
    }
  }
  // Update matrices exist from their front to their parent. They are placed first-fit in one arena.
  struct Interval {
    long begin, end;
  };
  std::vector<Interval> used;
  long arena = 0;
  for (int s = 0; s < count; ++s) {
    Front& f = front[std::size_t(s)];
    const int below = 3 * (f.rows - f.own);
    if (below > 0) {
      f.ldu = pad(below);
      const long size = long(f.ldu) * pad(below) + 64;
      std::sort(used.begin(), used.end(), [](auto& x, auto& y) { return x.begin < y.begin; });
      long at = 0;
      for (const Interval& i : used) {
        if (i.begin - at >= size) break;
        at = std::max(at, i.end);
      }
      f.update = at;
      used.push_back({at, at + size});
      arena = std::max(arena, at + size);
    }
    for (int c : f.children) {
      const long at = front[std::size_t(c)].update;
      used.erase(std::find_if(used.begin(), used.end(), [at](auto& i) { return i.begin == at; }));
    }
  }
  panel_size = panel;
  arena_size = arena;

  // Target of each block of A.
  std::vector<std::vector<Scatter>> by_front(static_cast<std::size_t>(count));
  for (int j = 0; j < nodes; ++j)
    for (int slot = a.column_start(j); slot < (j + 1 < nodes ? a.column_start(j + 1) : a.slots()); ++slot) {
      int pr = permuted[std::size_t(a.row(slot))], pc = permuted[std::size_t(j)];
      const bool transpose = pr < pc;
      if (transpose) std::swap(pr, pc);
      const int s = front_of[std::size_t(pc)];
      const Front& f = front[std::size_t(s)];
      const auto begin = row_node.begin() + f.row_begin;
      const int local = int(std::lower_bound(begin, begin + f.rows, pr) - begin);
      by_front[std::size_t(s)].push_back({slot, f.panel + long(3 * (pc - f.first)) * f.lda + 3 * local, transpose});
    }
  for (int s = 0; s < count; ++s) {
    Front& f = front[std::size_t(s)];
    f.scatter_begin = int(scatter.size());
    scatter.insert(scatter.end(), by_front[std::size_t(s)].begin(), by_front[std::size_t(s)].end());
    f.scatter_end = int(scatter.size());
  }
}

}  // namespace insula
