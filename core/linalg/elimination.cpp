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

int padded(int n, int lanes) { return (n + lanes - 1) & -lanes; }

/// Rows, place in the panels and cost of each front.
void set_fronts(Elimination& e, const Supernodes& sn, int lanes) {
  const int count = int(sn.super.size()) - 1;
  e.front.resize(std::size_t(count));
  e.front_of.assign(std::size_t(e.nodes), 0);
  for (int s = 0; s < count; ++s) {
    Front& f = e.front[std::size_t(s)];
    f.first = sn.super[std::size_t(s)];
    f.own = sn.super[std::size_t(s) + 1] - f.first;
    f.row_begin = sn.row_start[std::size_t(s)];
    f.rows = sn.row_start[std::size_t(s) + 1] - f.row_begin;
    f.lda = padded(3 * f.rows, lanes);
    f.panel = e.panel_size;
    e.panel_size += long(f.lda) * 3 * f.own;
    for (int k = 0; k < f.own; ++k) e.front_of[std::size_t(f.first + k)] = s;
    const double n = 3.0 * f.own, m = 3.0 * f.rows;
    e.entries += std::int64_t(n * m - n * (n - 1) / 2);
    e.flops += n * n * n / 3 + n * n * (m - n) + n * (m - n) * (m - n);
  }
}

/// Parents, and where a child's rows stand in its parent.
void link_parents(Elimination& e) {
  for (std::size_t s = 0; s < e.front.size(); ++s) {
    Front& f = e.front[s];
    if (f.rows == f.own) continue;
    f.parent = e.front_of[std::size_t(e.row_node[std::size_t(f.row_begin + f.own)])];
    Front& p = e.front[std::size_t(f.parent)];
    p.children.push_back(int(s));
    f.map_begin = int(e.map.size());
    int at = 0;
    for (int r = f.own; r < f.rows; ++r) {
      const int node = e.row_node[std::size_t(f.row_begin + r)];
      while (e.row_node[std::size_t(p.row_begin + at)] != node) ++at;
      e.map.push_back(at);
    }
  }
}

/// Update matrices live from their front to their parent: first-fit in one arena.
void place_updates(Elimination& e, int lanes) {
  struct Interval {
    long begin, end;
  };
  std::vector<Interval> used;
  for (Front& f : e.front) {
    const int below = 3 * (f.rows - f.own);
    if (below > 0) {
      f.ldu = padded(below, lanes);
      const long size = long(f.ldu) * padded(below, lanes) + 64;
      std::sort(used.begin(), used.end(), [](auto& x, auto& y) { return x.begin < y.begin; });
      long at = 0;
      for (const Interval& i : used) {
        if (i.begin - at >= size) break;
        at = std::max(at, i.end);
      }
      f.update = at;
      used.push_back({at, at + size});
      e.arena_size = std::max(e.arena_size, at + size);
    }
    for (int c : f.children) {
      const long at = e.front[std::size_t(c)].update;
      used.erase(std::find_if(used.begin(), used.end(), [at](auto& i) { return i.begin == at; }));
    }
  }
}

/// Where each block of A goes.
void set_scatter(Elimination& e, const BlockMatrix& a) {
  std::vector<std::vector<Elimination::Scatter>> by_front(e.front.size());
  for (int j = 0; j < e.nodes; ++j)
    for (int slot = a.column_start(j); slot < (j + 1 < e.nodes ? a.column_start(j + 1) : a.slots()); ++slot) {
      int pr = e.permuted[std::size_t(a.row(slot))], pc = e.permuted[std::size_t(j)];
      const bool transpose = pr < pc;
      if (transpose) std::swap(pr, pc);
      const std::size_t s = std::size_t(e.front_of[std::size_t(pc)]);
      const Front& f = e.front[s];
      const auto begin = e.row_node.begin() + f.row_begin;
      const int local = int(std::lower_bound(begin, begin + f.rows, pr) - begin);
      by_front[s].push_back({slot, f.panel + long(3 * (pc - f.first)) * f.lda + 3 * local, transpose});
    }
  for (std::size_t s = 0; s < e.front.size(); ++s) {
    e.front[s].scatter_begin = int(e.scatter.size());
    e.scatter.insert(e.scatter.end(), by_front[s].begin(), by_front[s].end());
    e.front[s].scatter_end = int(e.scatter.size());
  }
}

}  // namespace

void Elimination::analyse(const BlockMatrix& a, int lanes) {
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
  set_fronts(*this, sn, lanes);
  link_parents(*this);
  place_updates(*this, lanes);
  set_scatter(*this, a);
}

}  // namespace insula
