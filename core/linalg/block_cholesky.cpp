// SPDX-License-Identifier: GPL-3.0-or-later
// Symbolic analysis, numeric factor and single right-hand sides. Many right-hand sides: block_compliance.cpp.
#include "core/linalg/block_cholesky.h"

#include <cholmod.h>

#include <cmath>
#include <cstring>
#include <limits>
#include <stdexcept>

#include "core/linalg/dot.h"
#include "core/linalg/kernels.h"

namespace insula {
namespace {

constexpr int pad(int n) { return (n + 7) & ~7; }

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

void BlockCholesky::analyse(const BlockMatrix& a) {
  nodes_ = a.nodes();
  front_.clear();
  scatter_.clear();
  map_.clear();
  entries_ = 0;
  flops_ = 0;
  if (nodes_ == 0) return;
  const Supernodes sn = analyse_graph(a);
  natural_ = sn.permutation;
  permuted_.assign(std::size_t(nodes_), 0);
  for (int p = 0; p < nodes_; ++p) permuted_[std::size_t(natural_[std::size_t(p)])] = p;
  row_node_ = sn.row;
  row_scalar_.resize(3 * row_node_.size());
  for (std::size_t r = 0; r < row_node_.size(); ++r)
    for (int k = 0; k < 3; ++k) row_scalar_[3 * r + std::size_t(k)] = 3 * row_node_[r] + k;

  const int count = int(sn.super.size()) - 1;
  front_.resize(std::size_t(count));
  front_of_.assign(std::size_t(nodes_), 0);
  long panel = 0;
  for (int s = 0; s < count; ++s) {
    Front& f = front_[std::size_t(s)];
    f.first = sn.super[std::size_t(s)];
    f.own = sn.super[std::size_t(s) + 1] - f.first;
    f.row_begin = sn.row_start[std::size_t(s)];
    f.rows = sn.row_start[std::size_t(s) + 1] - f.row_begin;
    f.lda = pad(3 * f.rows);
    f.panel = panel;
    panel += long(f.lda) * 3 * f.own;
    f.first_descendant = f.first;
    for (int k = 0; k < f.own; ++k) front_of_[std::size_t(f.first + k)] = s;
    const double n = 3.0 * f.own, m = 3.0 * f.rows;
    entries_ += std::int64_t(n * m - n * (n - 1) / 2);
    flops_ += n * n * n / 3 + n * n * (m - n) + n * (m - n) * (m - n);
  }
  // Parents and where a child's rows stand in its parent.
  for (int s = 0; s < count; ++s) {
    Front& f = front_[std::size_t(s)];
    if (f.rows == f.own) continue;
    f.parent = front_of_[std::size_t(row_node_[std::size_t(f.row_begin + f.own)])];
    Front& p = front_[std::size_t(f.parent)];
    p.children.push_back(s);
    p.first_descendant = std::min(p.first_descendant, f.first_descendant);
    f.map_begin = int(map_.size());
    int at = 0;
    for (int r = f.own; r < f.rows; ++r) {
      const int node = row_node_[std::size_t(f.row_begin + r)];
      while (row_node_[std::size_t(p.row_begin + at)] != node) ++at;
      map_.push_back(at);
    }
  }
  // Update matrices live from their front to their parent: first-fit in one arena.
  struct Interval {
    long begin, end;
  };
  std::vector<Interval> used;
  long arena = 0;
  for (int s = 0; s < count; ++s) {
    Front& f = front_[std::size_t(s)];
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
      const long at = front_[std::size_t(c)].update;
      used.erase(std::find_if(used.begin(), used.end(), [at](auto& i) { return i.begin == at; }));
    }
  }
  panel_.assign(std::size_t(panel) + 64, 0.0);
  update_.assign(std::size_t(arena) + 64, 0.0);
  x_.assign(3 * std::size_t(nodes_) + 64, 0.0);
  below_.assign(3 * std::size_t(nodes_) + 64, 0.0);
  s_.assign(3 * std::size_t(nodes_) + 64, 0.0);

  // Where each block of A goes.
  std::vector<std::vector<Scatter>> by_front(static_cast<std::size_t>(count));
  for (int j = 0; j < nodes_; ++j)
    for (int slot = a.column_start(j); slot < (j + 1 < nodes_ ? a.column_start(j + 1) : a.slots()); ++slot) {
      int pr = permuted_[std::size_t(a.row(slot))], pc = permuted_[std::size_t(j)];
      const bool transpose = pr < pc;
      if (transpose) std::swap(pr, pc);
      const int s = front_of_[std::size_t(pc)];
      const Front& f = front_[std::size_t(s)];
      const auto begin = row_node_.begin() + f.row_begin;
      const int local = int(std::lower_bound(begin, begin + f.rows, pr) - begin);
      by_front[std::size_t(s)].push_back({slot, f.panel + long(3 * (pc - f.first)) * f.lda + 3 * local, transpose});
    }
  for (int s = 0; s < count; ++s) {
    Front& f = front_[std::size_t(s)];
    f.scatter_begin = int(scatter_.size());
    scatter_.insert(scatter_.end(), by_front[std::size_t(s)].begin(), by_front[std::size_t(s)].end());
    f.scatter_end = int(scatter_.size());
  }
}

bool BlockCholesky::factorise(const BlockMatrix& a) {
  const Kernels& k = kernels();
  double largest = 0;
  for (int j = 0; j < nodes_; ++j) {
    const double* d = a.block(a.diagonal(j));
    largest = std::max({largest, d[0], d[4], d[8]});
  }
  const double floor = largest * 1e-14;
  for (const Front& f : front_) {
    double* panel = panel_.data() + f.panel;
    const int own = 3 * f.own, rows = 3 * f.rows, below = rows - own;
    std::memset(panel, 0, sizeof(double) * std::size_t(f.lda) * std::size_t(own));
    for (int i = f.scatter_begin; i < f.scatter_end; ++i) {
      const Scatter& sc = scatter_[std::size_t(i)];
      const double* b = a.block(sc.slot);
      double* to = panel_.data() + sc.offset;
      for (int c = 0; c < 3; ++c)
        for (int r = 0; r < 3; ++r) to[long(c) * f.lda + r] = sc.transpose ? b[3 * r + c] : b[3 * c + r];
    }
    double* update = f.update >= 0 ? update_.data() + f.update : nullptr;
    if (update) std::memset(update, 0, sizeof(double) * std::size_t(f.ldu) * std::size_t(pad(below)));
    // Extend-add the children's update matrices.
    for (int c : f.children) {
      const Front& child = front_[std::size_t(c)];
      const int n = child.rows - child.own;
      const int* map = map_.data() + child.map_begin;
      const double* u = update_.data() + child.update;
      for (int j = 0; j < n; ++j) {
        const int pj = map[j];
        const bool in_panel = pj < f.own;
        for (int jj = 0; jj < 3; ++jj) {
          const double* from = u + long(3 * j + jj) * child.ldu;
          double* to = in_panel ? panel + long(3 * pj + jj) * f.lda : update + long(3 * (pj - f.own) + jj) * f.ldu - own;
          for (int i = j; i < n; ++i) {
            double* t = to + 3 * map[i];
            const double* g = from + 3 * i;
            t[0] += g[0];
            t[1] += g[1];
            t[2] += g[2];
          }
        }
      }
    }
    if (k.cholesky_panel(panel, f.lda, rows, own, floor) >= 0) return false;
    if (below > 0) k.syrk_sub(update, f.ldu, panel + own, f.lda, below, own);
  }
  return true;
}

// Both gather what lies below a front once, so that its columns run over memory in order.
void BlockCholesky::forward(double* x) {
  const Kernels& k = kernels();
  double* t = below_.data();
  for (const Front& f : front_) {
    const double* l = panel_.data() + f.panel;
    const int own = 3 * f.own, below = 3 * f.rows - own;
    double* xo = x + 3 * f.first;
    const int* index = row_scalar_.data() + 3 * f.row_begin + own;
    for (int r = 0; r < below; ++r) t[r] = x[index[r]];
    for (int c = 0; c < own; ++c) {
      const double* col = l + long(c) * f.lda;
      const double v = xo[c] / col[c];
      xo[c] = v;
      for (int r = c + 1; r < own; ++r) xo[r] -= col[r] * v;
      k.axpy(t, col + own, -v, below);
    }
    for (int r = 0; r < below; ++r) x[index[r]] = t[r];
  }
}

void BlockCholesky::backward(double* x) {
  double* t = below_.data();
  for (auto it = front_.rbegin(); it != front_.rend(); ++it) {
    const Front& f = *it;
    const double* l = panel_.data() + f.panel;
    const int own = 3 * f.own, below = 3 * f.rows - own;
    double* xo = x + 3 * f.first;
    const int* index = row_scalar_.data() + 3 * f.row_begin + own;
    for (int r = 0; r < below; ++r) t[r] = x[index[r]];
    for (int c = own - 1; c >= 0; --c) {
      const double* col = l + long(c) * f.lda;
      const double v = xo[c] - dot(col + own, t, below) - dot(col + c + 1, xo + c + 1, own - c - 1);
      xo[c] = v / col[c];
    }
  }
}

void BlockCholesky::solve(double* x) {
  for (int p = 0; p < nodes_; ++p)
    for (int k = 0; k < 3; ++k) x_[std::size_t(3 * p + k)] = x[3 * natural_[std::size_t(p)] + k];
  forward(x_.data());
  backward(x_.data());
  for (int p = 0; p < nodes_; ++p)
    for (int k = 0; k < 3; ++k) x[3 * natural_[std::size_t(p)] + k] = x_[std::size_t(3 * p + k)];
}

}  // namespace insula
