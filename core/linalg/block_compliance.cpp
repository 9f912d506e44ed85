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
void BlockCholesky::begin_compliance(const BodyRows& rows, const std::vector<int>& node_of_block) {
  const int m = rows.count();
  columns_ = m;
  if (m == 0 || nodes_ == 0) return;
  // First and last touched column of each row.
  begin_.resize(std::size_t(m));
  order_.resize(std::size_t(m));
  for (int r = 0; r < m; ++r) {
    int first = nodes_;
    for (int e = rows.start[std::size_t(r)]; e < rows.start[std::size_t(r) + 1]; ++e) {
      const int node = node_of_block[std::size_t(rows.block[std::size_t(e)])];
      if (node >= 0) first = std::min(first, permuted_[std::size_t(node)]);
    }
    begin_[std::size_t(r)] = first;
    order_[std::size_t(r)] = r;
  }
  std::sort(order_.begin(), order_.end(), [this](int x, int y) {
    const int bx = begin_[std::size_t(x)], by = begin_[std::size_t(y)];
    return bx != by ? bx < by : x < y;
  });
  ldy_ = (m + 7) & ~7;
  y_.resize(3 * std::size_t(nodes_) * std::size_t(ldy_) + 64);

  // Which columns are active at each front: from its own entries and its children's ranges.
  active_lo_.assign(front_.size(), m);
  active_hi_.assign(front_.size(), 0);
  for (int c = 0; c < m; ++c) {
    const int r = order_[std::size_t(c)];
    for (int e = rows.start[std::size_t(r)]; e < rows.start[std::size_t(r) + 1]; ++e) {
      const int node = node_of_block[std::size_t(rows.block[std::size_t(e)])];
      if (node < 0) continue;
      const std::size_t f = std::size_t(front_of_[std::size_t(permuted_[std::size_t(node)])]);
      active_lo_[f] = std::min(active_lo_[f], c);
      active_hi_[f] = std::max(active_hi_[f], c + 1);
    }
  }
  for (std::size_t f = 0; f < front_.size(); ++f) {
    if (active_lo_[f] >= active_hi_[f]) continue;
    active_lo_[f] &= ~7;  // whole vectors
    active_hi_[f] = std::min(int(ldy_), (active_hi_[f] + 7) & ~7);
    if (front_[f].parent >= 0) {
      const std::size_t p = std::size_t(front_[f].parent);
      active_lo_[p] = std::min(active_lo_[p], active_lo_[f]);
      active_hi_[p] = std::max(active_hi_[p], active_hi_[f]);
    }
    const int width = active_hi_[f] - active_lo_[f];
    for (int i = 0; i < 3 * front_[f].own; ++i)
      std::memset(y_.data() + (3L * front_[f].first + i) * ldy_ + active_lo_[f], 0, sizeof(double) * std::size_t(width));
  }
  for (int c = 0; c < m; ++c) {
    const int r = order_[std::size_t(c)];
    for (int e = rows.start[std::size_t(r)]; e < rows.start[std::size_t(r) + 1]; ++e) {
      const int node = node_of_block[std::size_t(rows.block[std::size_t(e)])];
      if (node < 0) continue;
      const Vec3& h = rows.coeff[std::size_t(e)];
      double* to = y_.data() + 3L * permuted_[std::size_t(node)] * ldy_ + c;
      to[0] += h.x();
      to[ldy_] += h.y();
      to[2 * ldy_] += h.z();
    }
  }
  s_.resize(std::max(s_.size(), std::size_t(ldy_) * std::size_t(ldy_ + 8) + 64));
}

// Forward substitution of some columns, front by front: columns know nothing of each other.
void BlockCholesky::compliance_part(int part) {
  const Kernels& k = kernels();
  const long whole = ldy_ / 8, parts = compliance_parts();  // vectors of eight columns
  const int from = int(8 * (whole * part / parts)), to = int(8 * (whole * (part + 1) / parts));
  for (std::size_t i = 0; i < front_.size(); ++i) {
    const Front& f = front_[i];
    const int lo = std::max(active_lo_[i], from), hi = std::min(active_hi_[i], to);
    if (lo >= hi) continue;
    const double* l = panel_.data() + f.panel;
    const int own = 3 * f.own, below = 3 * f.rows - own;
    double* x = y_.data() + 3L * f.first * ldy_ + lo;
    k.lower_solve_rows(l, f.lda, own, x, ldy_, hi - lo);
    if (below > 0)
      k.rows_sub(y_.data() + lo, ldy_, row_scalar_.data() + 3 * f.row_begin + own, below, l + own, f.lda, x, ldy_, own, hi - lo);
  }
}

// W = Y^T Y.
void BlockCholesky::end_compliance() {
  if (columns_ == 0 || nodes_ == 0) return;
  const Kernels& k = kernels();
  std::memset(s_.data(), 0, sizeof(double) * std::size_t(ldy_) * std::size_t(ldy_));
  for (std::size_t i = 0; i < front_.size(); ++i) {
    const Front& f = front_[i];
    const int lo = active_lo_[i], hi = active_hi_[i];
    if (lo < hi) k.syrk_add(s_.data() + long(lo) * ldy_ + lo, int(ldy_), y_.data() + 3L * f.first * ldy_ + lo, int(ldy_), hi - lo, 3 * f.own);
  }
}

void BlockCholesky::add_compliance(const BodyRows& rows, double* w, int stride) const {
  const int m = nodes_ > 0 ? columns_ : 0;
  for (int c = 0; c < m; ++c) {
    const int rc = rows.row[std::size_t(order_[std::size_t(c)])];
    const double* from = s_.data() + long(c) * ldy_;
    w[std::size_t(rc) * std::size_t(stride) + std::size_t(rc)] += from[c];
    for (int r = c + 1; r < m; ++r) {
      const int rr = rows.row[std::size_t(order_[std::size_t(r)])];
      w[std::size_t(rc) * std::size_t(stride) + std::size_t(rr)] += from[r];
      w[std::size_t(rr) * std::size_t(stride) + std::size_t(rc)] += from[r];
    }
  }
}

void BlockCholesky::correct(const BodyRows& rows, const double* lambda, double* x) {
  std::fill(x_.begin(), x_.end(), 0.0);
  if (columns_ > 0 && nodes_ > 0) {
    lambda_.resize(std::size_t(ldy_));
    for (long c = 0; c < ldy_; ++c)
      lambda_[std::size_t(c)] = c < columns_ ? lambda[rows.row[std::size_t(order_[std::size_t(c)])]] : 0.0;
    for (std::size_t i = 0; i < front_.size(); ++i) {
      const int lo = active_lo_[i], hi = active_hi_[i];
      if (lo >= hi) continue;
      for (int r = 0; r < 3 * front_[i].own; ++r) {
        x_[std::size_t(3 * front_[i].first + r)] = dot(y_.data() + (3L * front_[i].first + r) * ldy_ + lo, lambda_.data() + lo, hi - lo);
      }
    }
    backward(x_.data());
  }
  for (int p = 0; p < nodes_; ++p)
    for (int q = 0; q < 3; ++q) x[3 * natural_[std::size_t(p)] + q] = x_[std::size_t(3 * p + q)];
}

}  // namespace insula
