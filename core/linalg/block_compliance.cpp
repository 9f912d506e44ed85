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
  const bool kept = rows_factor_ == factor_number_;
  columns_ = m;
  rows_factor_ = m > 0 && e_.nodes > 0 ? factor_number_ : -1;
  reused_ = 0;
  unchanged_ = false;
  if (m == 0 || e_.nodes == 0) return;
  std::swap(entries_, before_);
  entries_.take(rows, node_of_block, e_.permuted);
  known_.assign(std::size_t(m), -1);
  bool same = kept && before_.count() == m;
  for (int r = 0; kept && r < m; ++r) {
    known_[std::size_t(r)] = before_.find(entries_, r);
    reused_ += known_[std::size_t(r)] >= 0;
    same = same && known_[std::size_t(r)] == r;
  }
  unchanged_ = same;
  if (same) return;
  if (reused_ > 0) {
    std::swap(y_, old_y_);
    std::swap(s_, old_s_);
    std::swap(order_, old_order_);
    for (int g = 0; g < 2; ++g) std::swap(active_[g], old_active_[g]);
    old_column_.assign(std::size_t(before_.count()), -1);
    for (std::size_t c = 0; c < old_order_.size(); ++c)
      if (old_order_[c] >= 0) old_column_[std::size_t(old_order_[c])] = int(c);
  }
  old_ldy_ = ldy_;
  arrange();
  y_.resize(std::max(y_.size(), 3 * std::size_t(e_.nodes) * std::size_t(ldy_) + slack));
  s_.resize(std::max(s_.size(), std::size_t(ldy_) * std::size_t(ldy_ + lanes) + slack));
  of_load_.resize(std::max(of_load_.size(), std::size_t(ldy_) + slack));
  clear_fresh();
  if (reused_ > 0) copy_known();
  for (long c = 0; c < fresh_; ++c) {
    const int r = order_[std::size_t(c)];
    if (r < 0) continue;
    for (int e = entries_.start[std::size_t(r)]; e < entries_.start[std::size_t(r) + 1]; ++e) {
      const Vec3& h = entries_.coeff[std::size_t(e)];
      Real* to = y_.data() + 3L * entries_.node[std::size_t(e)] * ldy_ + c;
      to[0] += Real(h.x());
      to[ldy_] += Real(h.y());
      to[2 * ldy_] += Real(h.z());
    }
  }
  share_out();
}

// Gives every row its column, new rows first, and every front its active columns: those of its own entries and of its
// children.
template <class Real>
void MultifrontalCholesky<Real>::arrange() {
  const int m = columns_;
  begin_.resize(std::size_t(m));
  order_.resize(std::size_t(m));
  for (int r = 0; r < m; ++r) {
    int first = e_.nodes;
    for (int e = entries_.start[std::size_t(r)]; e < entries_.start[std::size_t(r) + 1]; ++e)
      first = std::min(first, entries_.node[std::size_t(e)]);
    begin_[std::size_t(r)] = first;
    order_[std::size_t(r)] = r;
  }
  std::sort(order_.begin(), order_.end(), [this](int x, int y) {
    const bool kx = known_[std::size_t(x)] >= 0, ky = known_[std::size_t(y)] >= 0;
    if (kx != ky) return ky;
    const int bx = begin_[std::size_t(x)], by = begin_[std::size_t(y)];
    return bx != by ? bx < by : x < y;
  });
  const auto pad = [](int n) { return (n + lanes - 1) & -lanes; };
  const int fresh = m - reused_;
  fresh_ = pad(fresh);
  ldy_ = fresh_ + pad(reused_);
  order_.insert(order_.begin() + fresh, std::size_t(fresh_ - fresh), -1);
  order_.resize(std::size_t(ldy_), -1);

  for (auto& group : active_) group.assign(e_.front.size(), {int(ldy_), 0});
  for (int c = 0; c < ldy_; ++c) {
    const int r = order_[std::size_t(c)];
    if (r < 0) continue;
    for (int e = entries_.start[std::size_t(r)]; e < entries_.start[std::size_t(r) + 1]; ++e) {
      Columns& a = active_[c < fresh_ ? 0 : 1][std::size_t(e_.front_of[std::size_t(entries_.node[std::size_t(e)])])];
      a.begin = std::min(a.begin, c);
      a.end = std::max(a.end, c + 1);
    }
  }
  for (auto& group : active_)
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
    if (const Columns& a = active_[0][f]; a.begin < a.end)
      for (int i = 0; i < 3 * e_.front[f].own; ++i)
        std::memset(y_.data() + (3L * e_.front[f].first + i) * ldy_ + a.begin, 0,
                    sizeof(Real) * std::size_t(a.end - a.begin));
}

// Copies the known columns from the last Y. Entries that were not active there are zero.
template <class Real>
void MultifrontalCholesky<Real>::copy_known() {
  for (std::size_t f = 0; f < e_.front.size(); ++f) {
    const Columns& a = active_[1][f];
    if (a.begin >= a.end) continue;
    from_.clear();
    for (int c = a.begin; c < a.end; ++c) {
      const int r = order_[std::size_t(c)], old = r < 0 ? -1 : old_column_[std::size_t(known_[std::size_t(r)])];
      const bool there = old >= 0 && ((old >= old_active_[0][f].begin && old < old_active_[0][f].end) ||
                                      (old >= old_active_[1][f].begin && old < old_active_[1][f].end));
      from_.push_back(there ? old : -1);
    }
    for (long row = 3L * e_.front[f].first; row < 3L * (e_.front[f].first + e_.front[f].own); ++row) {
      Real* to = y_.data() + row * ldy_ + a.begin;
      const Real* old = old_y_.data() + row * old_ldy_;
      for (std::size_t c = 0; c < from_.size(); ++c) to[c] = from_[c] >= 0 ? old[from_[c]] : Real(0);
    }
  }
}

// Divides the columns into parts of equal work. Every part of the forward act reads the whole factor, so a factor
// larger than the caches gets as few parts as possible.
template <class Real>
void MultifrontalCholesky<Real>::share_out() {
  constexpr std::size_t cached = std::size_t(2) << 20;
  const int whole = int(fresh_) / lanes;  // vectors of columns
  for (const ComplianceAct act : compliance_acts) {
    auto& begin = part_begin_[std::size_t(act)];
    begin.clear();
    if (whole > 0) begin.push_back(0);
    if (fresh_ >= 2 * min_part) {
      work_.assign(std::size_t(whole), 0.0);
      double all = 0;
      for (std::size_t i = 0; i < e_.front.size(); ++i) {
        const Columns &a = active_[0][i], &b = active_[1][i];
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
    if (whole > 0) begin.push_back(int(fresh_));
  }
}

template <class Real>
int MultifrontalCholesky<Real>::compliance_parts(ComplianceAct act) const {
  if (columns_ == 0 || e_.nodes == 0) return 0;
  const int parts = unchanged_ ? 0 : std::max(0, int(part_begin_[std::size_t(act)].size()) - 1);
  return act == ComplianceAct::product ? std::max(1, parts)
                                       : parts;  // the first part copies what is known; the load is never known
}

template <class Real>
void MultifrontalCholesky<Real>::compliance_part(ComplianceAct act, int part) {
  [[maybe_unused]] const FlushSubnormals<Real> flush;
  const auto& begin = part_begin_[std::size_t(act)];
  if (act == ComplianceAct::product && part == 0) {
    load_columns(1, int(fresh_), int(ldy_));
    if (unchanged_) return load_columns(0, 0, int(fresh_));
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
    const int lo = std::max(active_[0][i].begin, from), hi = std::min(active_[0][i].end, to);
    if (lo >= hi) continue;
    const Real* l = panel_.data() + f.panel;
    const int own = 3 * f.own, below = 3 * f.rows - own;
    Real* x = y_.data() + 3L * f.first * ldy_ + lo;
    k.lower_solve_rows(l, f.lda, inverse_.data() + 3 * f.first, own, x, ldy_, hi - lo);
    if (below > 0)
      k.rows_sub(y_.data() + lo, ldy_, e_.row_scalar.data() + 3 * f.row_begin + own, below, l + own, f.lda, x, ldy_,
                 own, hi - lo);
  }
}

// W = Y^T Y: products of new columns with later new ones and with all known ones.
template <class Real>
void MultifrontalCholesky<Real>::product_columns(int from, int to) {
  const KernelsOf<Real>& k = kernels_of<Real>();
  const int ld = int(ldy_);
  load_columns(0, from, to);
  std::memset(s_.data() + long(from) * ldy_, 0, sizeof(Real) * std::size_t(to - from) * std::size_t(ldy_));
  for (std::size_t i = 0; i < e_.front.size(); ++i) {
    const Front& f = e_.front[i];
    const Columns &a = active_[0][i], &b = active_[1][i];
    const int lo = std::max(a.begin, from), hi = std::min(a.end, to);
    if (lo >= hi) continue;
    const Real* y = y_.data() + 3L * f.first * ldy_;
    Real* s = s_.data() + long(lo) * ldy_;
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
  std::fill(of_load_.begin() + from, of_load_.begin() + to, Real(0));
  for (std::size_t i = 0; i < e_.front.size(); ++i) {
    const Front& f = e_.front[i];
    const Columns& a = active_[std::size_t(group)][i];
    const int lo = std::max(a.begin, from), hi = std::min(a.end, to);
    if (lo < hi)
      k.columns_sub(of_load_.data() + lo, y_.data() + 3L * f.first * ldy_ + lo, ldy_, load_.data() + 3 * f.first,
                    hi - lo, 3 * f.own);
  }
}

template <class Real>
void MultifrontalCholesky<Real>::add_free_motion(const BodyRows& rows, double* delta) const {
  if (columns_ == 0 || e_.nodes == 0 || !loaded_) return;
  for (std::size_t c = 0; c < std::size_t(ldy_); ++c)
    if (order_[c] >= 0) delta[rows.row[std::size_t(order_[c])]] -= double(of_load_[c]);
}

template <class Real>
void MultifrontalCholesky<Real>::copy_known_products() {
  for (long c = fresh_; c < fresh_ + reused_; ++c)
    for (long r = c; r < fresh_ + reused_; ++r) {
      const int oc = old_column_[std::size_t(known_[std::size_t(order_[std::size_t(c)])])],
                o = old_column_[std::size_t(known_[std::size_t(order_[std::size_t(r)])])];
      s_[std::size_t(c * ldy_ + r)] =
          old_s_[std::size_t(std::min(oc, o)) * std::size_t(old_ldy_) + std::size_t(std::max(oc, o))];
    }
}

template <class Real>
void MultifrontalCholesky<Real>::add_compliance(const BodyRows& rows, double* w, int stride) {
  if (columns_ == 0 || e_.nodes == 0) return;
  const std::size_t ld = std::size_t(ldy_), step = std::size_t(stride);
  for (std::size_t c = 0; c < ld; ++c) {
    if (order_[c] < 0) continue;
    const std::size_t rc = std::size_t(rows.row[std::size_t(order_[c])]);
    const Real* from = s_.data() + c * ld;
    w[rc * step + rc] += double(from[c]);
    for (std::size_t r = c + 1; r < ld; ++r) {
      if (order_[r] < 0) continue;
      const std::size_t rr = std::size_t(rows.row[std::size_t(order_[r])]);
      w[rc * step + rr] += double(from[r]);
      w[rr * step + rc] += double(from[r]);
    }
  }
}

template <class Real>
void MultifrontalCholesky<Real>::combine(const BodyRows& rows, const double* lambda, Real* x) const {
  const KernelsOf<Real>& k = kernels_of<Real>();
  if (columns_ == 0) return;
  lambda_.resize(std::size_t(ldy_));
  for (std::size_t c = 0; c < lambda_.size(); ++c)
    lambda_[c] = order_[c] >= 0 ? Real(lambda[rows.row[std::size_t(order_[c])]]) : Real(0);
  products_.resize(x_.size());
  for (const auto& group : active_)
    for (std::size_t i = 0; i < e_.front.size(); ++i) {
      const Columns& a = group[i];
      if (a.begin >= a.end) continue;
      const int first = 3 * e_.front[i].first, own = 3 * e_.front[i].own;
      k.columns_dot(products_.data(), y_.data() + long(first) * ldy_ + a.begin, ldy_, lambda_.data() + a.begin,
                    a.end - a.begin, own);
      for (int r = 0; r < own; ++r) x[first + r] += products_[std::size_t(r)];
    }
}

template <class Real>
SolverCost MultifrontalCholesky<Real>::cost() const {
  SolverCost c;
  c.factor_entries = e_.entries;
  c.factor_flops = e_.flops;
  c.factor_bytes = 2.0 * sizeof(Real) * double(e_.entries);
  c.rows_reused = reused_;
  for (std::size_t i = 0; compliance_parts(ComplianceAct::forward) > 0 && i < e_.front.size(); ++i) {
    const double fresh = std::max(0, active_[0][i].end - active_[0][i].begin),
                 known = std::max(0, active_[1][i].end - active_[1][i].begin);
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
