// SPDX-License-Identifier: GPL-3.0-or-later
// The Delassus operator of one body: Y = L^-1 P H^T on the reach of the rows, W = Y^T Y.
// Rows are sorted by the first column they touch. In a postordered tree the descendants of a supernode are one range
// of columns, so the rows active there are (nearly) one range too: only that range is solved and multiplied.
#include <algorithm>
#include <cstring>

#include "core/linalg/block_cholesky.h"
#include "core/linalg/dot.h"
#include "core/linalg/kernels.h"

namespace insula {

// Y = P H^T.
template <class Real>
void MultifrontalCholesky<Real>::begin_compliance(const BodyRows& rows, const std::vector<int>& node_of_block) {
  const int m = rows.count();
  columns_ = m;
  if (m == 0 || e_.nodes == 0) return;
  // First and last touched column of each row.
  begin_.resize(std::size_t(m));
  order_.resize(std::size_t(m));
  for (int r = 0; r < m; ++r) {
    int first = e_.nodes;
    for (int e = rows.start[std::size_t(r)]; e < rows.start[std::size_t(r) + 1]; ++e) {
      const int node = node_of_block[std::size_t(rows.block[std::size_t(e)])];
      if (node >= 0) first = std::min(first, e_.permuted[std::size_t(node)]);
    }
    begin_[std::size_t(r)] = first;
    order_[std::size_t(r)] = r;
  }
  std::sort(order_.begin(), order_.end(), [this](int x, int y) {
    const int bx = begin_[std::size_t(x)], by = begin_[std::size_t(y)];
    return bx != by ? bx < by : x < y;
  });
  ldy_ = (m + lanes - 1) & -lanes;
  y_.resize(3 * std::size_t(e_.nodes) * std::size_t(ldy_) + slack);

  // Which columns are active at each front: from its own entries and its children's ranges.
  active_lo_.assign(e_.front.size(), m);
  active_hi_.assign(e_.front.size(), 0);
  for (int c = 0; c < m; ++c) {
    const int r = order_[std::size_t(c)];
    for (int e = rows.start[std::size_t(r)]; e < rows.start[std::size_t(r) + 1]; ++e) {
      const int node = node_of_block[std::size_t(rows.block[std::size_t(e)])];
      if (node < 0) continue;
      const std::size_t f = std::size_t(e_.front_of[std::size_t(e_.permuted[std::size_t(node)])]);
      active_lo_[f] = std::min(active_lo_[f], c);
      active_hi_[f] = std::max(active_hi_[f], c + 1);
    }
  }
  for (std::size_t f = 0; f < e_.front.size(); ++f) {
    if (active_lo_[f] >= active_hi_[f]) continue;
    active_lo_[f] &= -lanes;  // whole vectors
    active_hi_[f] = std::min(int(ldy_), (active_hi_[f] + lanes - 1) & -lanes);
    if (e_.front[f].parent >= 0) {
      const std::size_t p = std::size_t(e_.front[f].parent);
      active_lo_[p] = std::min(active_lo_[p], active_lo_[f]);
      active_hi_[p] = std::max(active_hi_[p], active_hi_[f]);
    }
    const int width = active_hi_[f] - active_lo_[f];
    for (int i = 0; i < 3 * e_.front[f].own; ++i)
      std::memset(y_.data() + (3L * e_.front[f].first + i) * ldy_ + active_lo_[f], 0, sizeof(Real) * std::size_t(width));
  }
  for (int c = 0; c < m; ++c) {
    const int r = order_[std::size_t(c)];
    for (int e = rows.start[std::size_t(r)]; e < rows.start[std::size_t(r) + 1]; ++e) {
      const int node = node_of_block[std::size_t(rows.block[std::size_t(e)])];
      if (node < 0) continue;
      const Vec3& h = rows.coeff[std::size_t(e)];
      Real* to = y_.data() + 3L * e_.permuted[std::size_t(node)] * ldy_ + c;
      to[0] += Real(h.x());
      to[ldy_] += Real(h.y());
      to[2 * ldy_] += Real(h.z());
    }
  }
  s_.resize(std::max(s_.size(), std::size_t(ldy_) * std::size_t(ldy_ + lanes) + slack));
}

// Forward substitution of some columns, front by front: columns know nothing of each other.
template <class Real>
void MultifrontalCholesky<Real>::compliance_part(int part) {
  const KernelsOf<Real>& k = kernels_of<Real>();
  const long whole = ldy_ / lanes, parts = compliance_parts();  // whole vectors of columns
  const int from = int(lanes * (whole * part / parts)), to = int(lanes * (whole * (part + 1) / parts));
  for (std::size_t i = 0; i < e_.front.size(); ++i) {
    const Front& f = e_.front[i];
    const int lo = std::max(active_lo_[i], from), hi = std::min(active_hi_[i], to);
    if (lo >= hi) continue;
    const Real* l = panel_.data() + f.panel;
    const int own = 3 * f.own, below = 3 * f.rows - own;
    Real* x = y_.data() + 3L * f.first * ldy_ + lo;
    k.lower_solve_rows(l, f.lda, own, x, ldy_, hi - lo);
    if (below > 0)
      k.rows_sub(y_.data() + lo, ldy_, e_.row_scalar.data() + 3 * f.row_begin + own, below, l + own, f.lda, x, ldy_, own, hi - lo);
  }
}

// W = Y^T Y.
template <class Real>
void MultifrontalCholesky<Real>::end_compliance() {
  if (columns_ == 0 || e_.nodes == 0) return;
  const KernelsOf<Real>& k = kernels_of<Real>();
  std::memset(s_.data(), 0, sizeof(Real) * std::size_t(ldy_) * std::size_t(ldy_));
  for (std::size_t i = 0; i < e_.front.size(); ++i) {
    const Front& f = e_.front[i];
    const int lo = active_lo_[i], hi = active_hi_[i];
    if (lo < hi) k.syrk_add(s_.data() + long(lo) * ldy_ + lo, int(ldy_), y_.data() + 3L * f.first * ldy_ + lo, int(ldy_), hi - lo, 3 * f.own);
  }
}

template <class Real>
void MultifrontalCholesky<Real>::add_compliance(const BodyRows& rows, double* w, int stride) const {
  const int m = e_.nodes > 0 ? columns_ : 0;
  for (int c = 0; c < m; ++c) {
    const int rc = rows.row[std::size_t(order_[std::size_t(c)])];
    const Real* from = s_.data() + long(c) * ldy_;
    w[std::size_t(rc) * std::size_t(stride) + std::size_t(rc)] += double(from[c]);
    for (int r = c + 1; r < m; ++r) {
      const int rr = rows.row[std::size_t(order_[std::size_t(r)])];
      w[std::size_t(rc) * std::size_t(stride) + std::size_t(rr)] += double(from[r]);
      w[std::size_t(rr) * std::size_t(stride) + std::size_t(rc)] += double(from[r]);
    }
  }
}

template <class Real>
void MultifrontalCholesky<Real>::correct(const BodyRows& rows, const double* lambda, double* x) {
  std::fill(x_.begin(), x_.end(), Real(0));
  if (columns_ > 0 && e_.nodes > 0) {
    lambda_.resize(std::size_t(ldy_));
    for (long c = 0; c < ldy_; ++c)
      lambda_[std::size_t(c)] = c < columns_ ? Real(lambda[rows.row[std::size_t(order_[std::size_t(c)])]]) : Real(0);
    for (std::size_t i = 0; i < e_.front.size(); ++i) {
      const int lo = active_lo_[i], hi = active_hi_[i];
      if (lo >= hi) continue;
      for (int r = 0; r < 3 * e_.front[i].own; ++r) {
        x_[std::size_t(3 * e_.front[i].first + r)] = dot(y_.data() + (3L * e_.front[i].first + r) * ldy_ + lo, lambda_.data() + lo, hi - lo);
      }
    }
    backward(x_.data());
  }
  store(x);
}

#define INSULA_COMPLIANCE_OF(Real)                                                                            \
  template void MultifrontalCholesky<Real>::begin_compliance(const BodyRows&, const std::vector<int>&);       \
  template void MultifrontalCholesky<Real>::compliance_part(int);                                             \
  template void MultifrontalCholesky<Real>::end_compliance();                                                 \
  template void MultifrontalCholesky<Real>::add_compliance(const BodyRows&, double*, int) const;              \
  template void MultifrontalCholesky<Real>::correct(const BodyRows&, const double*, double*)
INSULA_COMPLIANCE_OF(double);
INSULA_COMPLIANCE_OF(float);
#undef INSULA_COMPLIANCE_OF

}  // namespace insula
