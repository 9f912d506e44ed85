// SPDX-License-Identifier: GPL-3.0-or-later
// The Delassus operator of one body: Y = L^-1 P H^T on the reach of the rows, W = Y^T Y. Rows are sorted by their first
// column. In a postordered tree the descendants of a supernode are one range of columns. The rows active there are
// therefore (nearly) one range too, and only that range is solved and multiplied. While the factor is the same,
// unchanged rows keep their columns of Y, and their block of W. They form a range of their own after the new rows.
#include <algorithm>
#include <cstring>

#include "core/linalg/block_cholesky.h"
#include "core/linalg/flush_subnormals.h"
#include "core/linalg/kernels.h"

namespace insula {

// Finds the known and the new rows, and sets Y = P H^T for the new ones.
template <class Real>
void MultifrontalCholesky<Real>::begin_compliance(const BodyRows& rows, const std::vector<int>& node_of_block) {
  const int m = rows.count();
  const bool kept = rows_.rows_factor == factor_number_;
  rows_.columns = m;
  rows_.rows_factor = m > 0 && e_.nodes > 0 ? factor_number_ : -1;
  rows_.reused = 0;
  rows_.unchanged = false;
  if (m == 0 || e_.nodes == 0) return;
  std::swap(rows_.entries, rows_.before);
  rows_.entries.take(rows, node_of_block, e_.permuted);
  rows_.known.assign(std::size_t(m), -1);
  bool same = kept && rows_.before.count() == m;
  for (int r = 0; kept && r < m; ++r) {
    rows_.known[std::size_t(r)] = rows_.before.find(rows_.entries, r);
    rows_.reused += rows_.known[std::size_t(r)] >= 0;
    same = same && rows_.known[std::size_t(r)] == r;
  }
  rows_.unchanged = same;
  if (same) return;
  if (rows_.reused > 0) {
    std::swap(rows_.y, rows_.old_y);
    std::swap(rows_.s, rows_.old_s);
    std::swap(rows_.order, rows_.old_order);
    for (int g = 0; g < 2; ++g) std::swap(rows_.active[g], rows_.old_active[g]);
    rows_.old_column.assign(std::size_t(rows_.before.count()), -1);
    for (std::size_t c = 0; c < rows_.old_order.size(); ++c)
      if (rows_.old_order[c] >= 0) rows_.old_column[std::size_t(rows_.old_order[c])] = int(c);
  }
  rows_.old_ldy = rows_.ldy;
  arrange();
  rows_.y.resize(std::max(rows_.y.size(), 3 * std::size_t(e_.nodes) * std::size_t(rows_.ldy) + slack));
  rows_.s.resize(std::max(rows_.s.size(), std::size_t(rows_.ldy) * std::size_t(rows_.ldy + lanes) + slack));
  rows_.of_load.resize(std::max(rows_.of_load.size(), std::size_t(rows_.ldy) + slack));
  clear_fresh();
  if (rows_.reused > 0) copy_known();
  for (long c = 0; c < rows_.fresh; ++c) {
    const int r = rows_.order[std::size_t(c)];
    if (r < 0) continue;
    for (int e = rows_.entries.start[std::size_t(r)]; e < rows_.entries.start[std::size_t(r) + 1]; ++e) {
      const Vec3& h = rows_.entries.coeff[std::size_t(e)];
      Real* to = rows_.y.data() + 3L * rows_.entries.node[std::size_t(e)] * rows_.ldy + c;
      to[0] += Real(h.x());
      to[rows_.ldy] += Real(h.y());
      to[2 * rows_.ldy] += Real(h.z());
    }
  }
  share_out();
}

// Gives every row its column, new rows first, and every front its active columns: those of its own entries and of its
// children.
template <class Real>
void MultifrontalCholesky<Real>::arrange() {
  const int m = rows_.columns;
  rows_.begin.resize(std::size_t(m));
  rows_.order.resize(std::size_t(m));
  for (int r = 0; r < m; ++r) {
    int first = e_.nodes;
    for (int e = rows_.entries.start[std::size_t(r)]; e < rows_.entries.start[std::size_t(r) + 1]; ++e)
      first = std::min(first, rows_.entries.node[std::size_t(e)]);
    rows_.begin[std::size_t(r)] = first;
    rows_.order[std::size_t(r)] = r;
  }
  std::sort(rows_.order.begin(), rows_.order.end(), [this](int x, int y) {
    const bool kx = rows_.known[std::size_t(x)] >= 0, ky = rows_.known[std::size_t(y)] >= 0;
    if (kx != ky) return ky;
    const int bx = rows_.begin[std::size_t(x)], by = rows_.begin[std::size_t(y)];
    return bx != by ? bx < by : x < y;
  });
  const auto pad = [](int n) { return (n + lanes - 1) & -lanes; };
  const int fresh = m - rows_.reused;
  rows_.fresh = pad(fresh);
  rows_.ldy = rows_.fresh + pad(rows_.reused);
  rows_.order.insert(rows_.order.begin() + fresh, std::size_t(rows_.fresh - fresh), -1);
  rows_.order.resize(std::size_t(rows_.ldy), -1);

  for (auto& group : rows_.active) group.assign(e_.front.size(), {int(rows_.ldy), 0});
  for (int c = 0; c < rows_.ldy; ++c) {
    const int r = rows_.order[std::size_t(c)];
    if (r < 0) continue;
    for (int e = rows_.entries.start[std::size_t(r)]; e < rows_.entries.start[std::size_t(r) + 1]; ++e) {
      Columns& a = rows_.active[c < rows_.fresh ? 0 : 1]
                               [std::size_t(e_.front_of[std::size_t(rows_.entries.node[std::size_t(e)])])];
      a.begin = std::min(a.begin, c);
      a.end = std::max(a.end, c + 1);
    }
  }
  for (auto& group : rows_.active)
    for (std::size_t f = 0; f < e_.front.size(); ++f) {
      Columns& a = group[f];
      if (a.begin >= a.end) continue;
      a.begin &= -lanes;  // whole vectors
      a.end = pad(a.end);
      if (e_.front[f].parent < 0) continue;
      Columns& p = group[std::size_t(e_.front[f].parent)];
      p.begin = std::min(p.begin, a.begin);
      p.end = std::max(p.end, a.end);
    }
}

template <class Real>
void MultifrontalCholesky<Real>::clear_fresh() {
  for (std::size_t f = 0; f < e_.front.size(); ++f)
    if (const Columns& a = rows_.active[0][f]; a.begin < a.end)
      for (int i = 0; i < 3 * e_.front[f].own; ++i)
        std::memset(rows_.y.data() + (3L * e_.front[f].first + i) * rows_.ldy + a.begin, 0,
                    sizeof(Real) * std::size_t(a.end - a.begin));
}

// Copies the known columns from the last Y. Entries that were not active there are zero.
template <class Real>
void MultifrontalCholesky<Real>::copy_known() {
  for (std::size_t f = 0; f < e_.front.size(); ++f) {
    const Columns& a = rows_.active[1][f];
    if (a.begin >= a.end) continue;
    from_.clear();
    for (int c = a.begin; c < a.end; ++c) {
      const int r = rows_.order[std::size_t(c)],
                old = r < 0 ? -1 : rows_.old_column[std::size_t(rows_.known[std::size_t(r)])];
      const bool there = old >= 0 && ((old >= rows_.old_active[0][f].begin && old < rows_.old_active[0][f].end) ||
                                      (old >= rows_.old_active[1][f].begin && old < rows_.old_active[1][f].end));
      from_.push_back(there ? old : -1);
    }
    for (long row = 3L * e_.front[f].first; row < 3L * (e_.front[f].first + e_.front[f].own); ++row) {
      Real* to = rows_.y.data() + row * rows_.ldy + a.begin;
      const Real* old = rows_.old_y.data() + row * rows_.old_ldy;
      for (std::size_t c = 0; c < from_.size(); ++c) to[c] = from_[c] >= 0 ? old[from_[c]] : Real(0);
    }
  }
}

// Divides the columns into parts of equal work. Every part of the forward act reads the whole factor, so a factor
// larger than the caches gets as few parts as possible.
template <class Real>
void MultifrontalCholesky<Real>::share_out() {
  constexpr std::size_t cached = std::size_t(2) << 20;
  const int whole = int(rows_.fresh) / lanes;  // vectors of columns
  for (const ComplianceAct act : compliance_acts) {
    auto& begin = rows_.part_begin[std::size_t(act)];
    begin.clear();
    if (whole > 0) begin.push_back(0);
    if (rows_.fresh >= 2 * min_part) {
      work_.assign(std::size_t(whole), 0.0);
      double all = 0;
      for (std::size_t i = 0; i < e_.front.size(); ++i) {
        const Columns &a = rows_.active[0][i], &b = rows_.active[1][i];
        const double own = 3 * e_.front[i].own, below = 3 * e_.front[i].rows - own,
                     known = std::max(0, b.end - b.begin);
        for (int c = a.begin; c < a.end; c += lanes) {
          const double flops = own * (act == ComplianceAct::forward ? own + 2 * below : a.end - c + 2 * known);
          work_[std::size_t(c / lanes)] += flops;
          all += flops;
        }
      }
      const int parts = act == ComplianceAct::forward && panel_.size() * sizeof(Real) > cached ? 2 : 4;
      double done = 0;
      for (int v = 0; v < whole; ++v) {
        if (int(begin.size()) < parts && v > 0 && done >= all * double(begin.size()) / parts)
          begin.push_back(lanes * v);
        done += work_[std::size_t(v)];
      }
    }
    if (whole > 0) begin.push_back(int(rows_.fresh));
  }
}

template <class Real>
int MultifrontalCholesky<Real>::compliance_parts(ComplianceAct act) const {
  if (rows_.columns == 0 || e_.nodes == 0) return 0;
  const int parts = rows_.unchanged ? 0 : std::max(0, int(rows_.part_begin[std::size_t(act)].size()) - 1);
  return act == ComplianceAct::product ? std::max(1, parts)
                                       : parts;  // the first part copies what is known; the load is never known
}

template <class Real>
void MultifrontalCholesky<Real>::compliance_part(ComplianceAct act, int part) {
  [[maybe_unused]] const FlushSubnormals<Real> flush;
  const auto& begin = rows_.part_begin[std::size_t(act)];
  if (act == ComplianceAct::product && part == 0) {
    load_columns(1, int(rows_.fresh), int(rows_.ldy));
    if (rows_.unchanged) return load_columns(0, 0, int(rows_.fresh));
    copy_known_products();
  }
  if (part + 1 >= int(begin.size())) return;
  const int from = begin[std::size_t(part)], to = begin[std::size_t(part) + 1];
  if (act == ComplianceAct::forward) forward_columns(from, to);
  else product_columns(from, to);
}

// Forward substitution, front by front. Columns are independent.
template <class Real>
void MultifrontalCholesky<Real>::forward_columns(int from, int to) {
  const KernelsOf<Real>& k = kernels_of<Real>();
  for (std::size_t i = 0; i < e_.front.size(); ++i) {
    const Front& f = e_.front[i];
    const int lo = std::max(rows_.active[0][i].begin, from), hi = std::min(rows_.active[0][i].end, to);
    if (lo >= hi) continue;
    const Real* l = panel_.data() + f.panel;
    const int own = 3 * f.own, below = 3 * f.rows - own;
    Real* x = rows_.y.data() + 3L * f.first * rows_.ldy + lo;
    k.lower_solve_rows(l, f.lda, inverse_.data() + 3 * f.first, own, x, rows_.ldy, hi - lo);
    if (below > 0)
      k.rows_sub(rows_.y.data() + lo, rows_.ldy, e_.row_scalar.data() + 3 * f.row_begin + own, below, l + own, f.lda, x,
                 rows_.ldy, own, hi - lo);
  }
}

// W = Y^T Y: products of new columns with later new ones and with all known ones.
template <class Real>
void MultifrontalCholesky<Real>::product_columns(int from, int to) {
  const KernelsOf<Real>& k = kernels_of<Real>();
  const int ld = int(rows_.ldy);
  load_columns(0, from, to);
  std::memset(rows_.s.data() + long(from) * rows_.ldy, 0,
              sizeof(Real) * std::size_t(to - from) * std::size_t(rows_.ldy));
  for (std::size_t i = 0; i < e_.front.size(); ++i) {
    const Front& f = e_.front[i];
    const Columns &a = rows_.active[0][i], &b = rows_.active[1][i];
    const int lo = std::max(a.begin, from), hi = std::min(a.end, to);
    if (lo >= hi) continue;
    const Real* y = rows_.y.data() + 3L * f.first * rows_.ldy;
    Real* s = rows_.s.data() + long(lo) * rows_.ldy;
    const int own = 3 * f.own;
    k.syrk_add(s + lo, ld, y + lo, ld, hi - lo, own);
    if (hi < a.end) k.gemm_add(s + hi, ld, y + hi, ld, y + lo, ld, a.end - hi, hi - lo, own);
    if (b.begin < b.end) k.gemm_add(s + b.begin, ld, y + b.begin, ld, y + lo, ld, b.end - b.begin, hi - lo, own);
  }
}

// Effect of the load on the rows, Y^T L^-1 P load, for the columns of one group.
template <class Real>
void MultifrontalCholesky<Real>::load_columns(int group, int from, int to) {
  if (!loaded_) return;
  const KernelsOf<Real>& k = kernels_of<Real>();
  std::fill(rows_.of_load.begin() + from, rows_.of_load.begin() + to, Real(0));
  for (std::size_t i = 0; i < e_.front.size(); ++i) {
    const Front& f = e_.front[i];
    const Columns& a = rows_.active[std::size_t(group)][i];
    const int lo = std::max(a.begin, from), hi = std::min(a.end, to);
    if (lo < hi)
      k.columns_sub(rows_.of_load.data() + lo, rows_.y.data() + 3L * f.first * rows_.ldy + lo, rows_.ldy,
                    load_.data() + 3 * f.first, hi - lo, 3 * f.own);
  }
}

template <class Real>
void MultifrontalCholesky<Real>::add_free_motion(const BodyRows& rows, double* delta) const {
  if (rows_.columns == 0 || e_.nodes == 0 || !loaded_) return;
  for (std::size_t c = 0; c < std::size_t(rows_.ldy); ++c)
    if (rows_.order[c] >= 0) delta[rows.row[std::size_t(rows_.order[c])]] -= double(rows_.of_load[c]);
}

template <class Real>
void MultifrontalCholesky<Real>::copy_known_products() {
  for (long c = rows_.fresh; c < rows_.fresh + rows_.reused; ++c)
    for (long r = c; r < rows_.fresh + rows_.reused; ++r) {
      const int oc = rows_.old_column[std::size_t(rows_.known[std::size_t(rows_.order[std::size_t(c)])])],
                o = rows_.old_column[std::size_t(rows_.known[std::size_t(rows_.order[std::size_t(r)])])];
      rows_.s[std::size_t(c * rows_.ldy + r)] =
          rows_.old_s[std::size_t(std::min(oc, o)) * std::size_t(rows_.old_ldy) + std::size_t(std::max(oc, o))];
    }
}

template <class Real>
void MultifrontalCholesky<Real>::add_compliance(const BodyRows& rows, double* w, int stride) {
  if (rows_.columns == 0 || e_.nodes == 0) return;
  const std::size_t ld = std::size_t(rows_.ldy), step = std::size_t(stride);
  for (std::size_t c = 0; c < ld; ++c) {
    if (rows_.order[c] < 0) continue;
    const std::size_t rc = std::size_t(rows.row[std::size_t(rows_.order[c])]);
    const Real* from = rows_.s.data() + c * ld;
    w[rc * step + rc] += double(from[c]);
    for (std::size_t r = c + 1; r < ld; ++r) {
      if (rows_.order[r] < 0) continue;
      const std::size_t rr = std::size_t(rows.row[std::size_t(rows_.order[r])]);
      w[rc * step + rr] += double(from[r]);
      w[rr * step + rc] += double(from[r]);
    }
  }
}

template <class Real>
void MultifrontalCholesky<Real>::combine(const BodyRows& rows, const double* lambda, Real* x) const {
  const KernelsOf<Real>& k = kernels_of<Real>();
  if (rows_.columns == 0) return;
  lambda_.resize(std::size_t(rows_.ldy));
  for (std::size_t c = 0; c < lambda_.size(); ++c)
    lambda_[c] = rows_.order[c] >= 0 ? Real(lambda[rows.row[std::size_t(rows_.order[c])]]) : Real(0);
  products_.resize(x_.size());
  for (const auto& group : rows_.active)
    for (std::size_t i = 0; i < e_.front.size(); ++i) {
      const Columns& a = group[i];
      if (a.begin >= a.end) continue;
      const int first = 3 * e_.front[i].first, own = 3 * e_.front[i].own;
      k.columns_dot(products_.data(), rows_.y.data() + long(first) * rows_.ldy + a.begin, rows_.ldy,
                    lambda_.data() + a.begin, a.end - a.begin, own);
      for (int r = 0; r < own; ++r) x[first + r] += products_[std::size_t(r)];
    }
}

template <class Real>
SolverCost MultifrontalCholesky<Real>::cost() const {
  SolverCost c;
  c.factor_entries = e_.entries;
  c.factor_flops = e_.flops;
  c.factor_bytes = 2.0 * sizeof(Real) * double(e_.entries);
  c.rows_reused = rows_.reused;
  for (std::size_t i = 0; compliance_parts(ComplianceAct::forward) > 0 && i < e_.front.size(); ++i) {
    const double fresh = std::max(0, rows_.active[0][i].end - rows_.active[0][i].begin),
                 known = std::max(0, rows_.active[1][i].end - rows_.active[1][i].begin);
    const double own = 3 * e_.front[i].own, below = 3 * e_.front[i].rows - own;
    c.compliance_flops += fresh * own * (own + 2 * below + fresh + 2 * known);
  }
  return c;
}

#define INSULA_COMPLIANCE_OF(Real)                                                                      \
  template void MultifrontalCholesky<Real>::begin_compliance(const BodyRows&, const std::vector<int>&); \
  template void MultifrontalCholesky<Real>::arrange();                                                  \
  template void MultifrontalCholesky<Real>::clear_fresh();                                              \
  template void MultifrontalCholesky<Real>::copy_known();                                               \
  template void MultifrontalCholesky<Real>::share_out();                                                \
  template int MultifrontalCholesky<Real>::compliance_parts(ComplianceAct) const;                       \
  template void MultifrontalCholesky<Real>::compliance_part(ComplianceAct, int);                        \
  template void MultifrontalCholesky<Real>::forward_columns(int, int);                                  \
  template void MultifrontalCholesky<Real>::product_columns(int, int);                                  \
  template void MultifrontalCholesky<Real>::load_columns(int, int, int);                                \
  template void MultifrontalCholesky<Real>::add_free_motion(const BodyRows&, double*) const;            \
  template void MultifrontalCholesky<Real>::copy_known_products();                                      \
  template void MultifrontalCholesky<Real>::add_compliance(const BodyRows&, double*, int);              \
  template void MultifrontalCholesky<Real>::combine(const BodyRows&, const double*, Real*) const;       \
  template SolverCost MultifrontalCholesky<Real>::cost() const
INSULA_COMPLIANCE_OF(double);
INSULA_COMPLIANCE_OF(float);
#undef INSULA_COMPLIANCE_OF

}  // namespace insula
