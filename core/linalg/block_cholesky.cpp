// SPDX-License-Identifier: GPL-3.0-or-later
// Numeric factor and single right-hand sides. Many right-hand sides: block_compliance.cpp.
#include "core/linalg/block_cholesky.h"

#include <algorithm>
#include <cstring>
#include <limits>

#include "core/linalg/flush_subnormals.h"
#include "core/linalg/kernels.h"

namespace insula {

template <class Real>
void MultifrontalCholesky<Real>::analyse(const BlockMatrix& a) {
  e_.analyse(a, lanes);
  panel_.assign(std::size_t(e_.panel_size) + slack, Real(0));
  update_.assign(std::size_t(e_.arena_size) + slack, Real(0));
  inverse_.assign(3 * std::size_t(e_.nodes), Real(0));
  x_.assign(3 * std::size_t(e_.nodes) + slack, Real(0));
  load_ = x_;
  loaded_ = false;
  gathered_.assign(3 * std::size_t(e_.nodes) + slack, Real(0));
  rows_.columns = 0;
  rows_.rows_factor = -1;
  second_rows_ = {};
}

template <class Real>
bool MultifrontalCholesky<Real>::factorise(const BlockMatrix& a) {
  [[maybe_unused]] const FlushSubnormals<Real> flush;
  ++factor_number_;
  loaded_ = false;
  for (const Front& f : e_.front)
    if (!factorise(a, f)) return false;
  return true;
}

template <class Real>
bool MultifrontalCholesky<Real>::factorise(const BlockMatrix& a, const Front& f) {
  const KernelsOf<Real>& k = kernels_of<Real>();
  Real* panel = panel_.data() + f.panel;
  const int own = 3 * f.own, rows = 3 * f.rows, below = rows - own;
  std::memset(panel, 0, sizeof(Real) * std::size_t(f.lda) * std::size_t(own));
  for (int i = f.scatter_begin; i < f.scatter_end; ++i) {
    const Elimination::Scatter& sc = e_.scatter[std::size_t(i)];
    const double* b = a.block(sc.slot);
    Real* to = panel_.data() + sc.offset;
    for (int c = 0; c < 3; ++c)
      for (int r = 0; r < 3; ++r) to[long(c) * f.lda + r] = Real(sc.transpose ? b[3 * r + c] : b[3 * c + r]);
  }
  Real* update = below > 0 ? update_.data() + f.update : nullptr;
  for (int j = 0; j < below; ++j) {  // its lower triangle
    const int top = j & -lanes;
    std::memset(update + long(j) * f.ldu + top, 0, sizeof(Real) * std::size_t(f.ldu - top));
  }
  for (int c : f.children) add_child(f, e_.front[std::size_t(c)]);
  if (k.cholesky_panel(panel, f.lda, rows, own, inverse_.data() + 3 * f.first) >= 0 || !pivots_are_good(a, f))
    return false;
  if (below > 0) k.syrk_sub(update, f.ldu, panel + own, f.lda, below, own);
  return true;
}

// Extend-add of a child's update matrix.
template <class Real>
void MultifrontalCholesky<Real>::add_child(const Front& f, const Front& child) {
  const int own = 3 * f.own, n = child.rows - child.own;
  const int* map = e_.map.data() + child.map_begin;
  const Real* u = update_.data() + child.update;
  Real* panel = panel_.data() + f.panel;
  Real* update = update_.data() + f.update;
  for (int j = 0; j < n; ++j) {
    const int pj = map[j];
    const bool in_panel = pj < f.own;
    for (int jj = 0; jj < 3; ++jj) {
      const Real* from = u + long(3 * j + jj) * child.ldu;
      Real* to = in_panel ? panel + long(3 * pj + jj) * f.lda : update + long(3 * (pj - f.own) + jj) * f.ldu - own;
      for (int i = j; i < n; ++i) {
        Real* t = to + 3 * map[i];
        const Real* g = from + 3 * i;
        t[0] += g[0];
        t[1] += g[1];
        t[2] += g[2];
      }
    }
  }
}

// A pivot as small as the rounding error of its diagonal entry shows that A is not positive definite in this precision.
// So does a pivot that is not finite.
template <class Real>
bool MultifrontalCholesky<Real>::pivots_are_good(const BlockMatrix& a, const Front& f) const {
  constexpr double least = 16 * double(std::numeric_limits<Real>::epsilon());
  for (int n = 0; n < f.own; ++n) {
    const double* d = a.block(a.diagonal(e_.natural[std::size_t(f.first + n)]));
    for (int i = 0; i < 3; ++i) {
      const double root = double(panel_[std::size_t(f.panel + long(3 * n + i) * (f.lda + 1))]);
      if (!(root * root > least * d[4 * i] && root <= double(std::numeric_limits<Real>::max()))) return false;
    }
  }
  return true;
}

// Both substitutions gather a front's part of x once, so that its columns are read in the order of memory.
template <class Real>
void MultifrontalCholesky<Real>::forward(const Front& f, Real* x) {
  Real* t = gathered_.data();
  const int rows = 3 * f.rows;
  const int* index = e_.row_scalar.data() + 3 * f.row_begin;
  for (int r = 0; r < rows; ++r) t[r] = x[index[r]];
  kernels_of<Real>().front_forward(panel_.data() + f.panel, f.lda, inverse_.data() + 3 * f.first, t, 3 * f.own, rows);
  for (int r = 0; r < rows; ++r) x[index[r]] = t[r];
}

template <class Real>
void MultifrontalCholesky<Real>::forward(Real* x) {
  for (const Front& f : e_.front) forward(f, x);
}

template <class Real>
void MultifrontalCholesky<Real>::backward(Real* x) {
  const KernelsOf<Real>& k = kernels_of<Real>();
  Real* t = gathered_.data();
  for (auto it = e_.front.rbegin(); it != e_.front.rend(); ++it) {
    const Front& f = *it;
    const int own = 3 * f.own, rows = 3 * f.rows;
    const int* index = e_.row_scalar.data() + 3 * f.row_begin;
    for (int r = 0; r < rows; ++r) t[r] = x[index[r]];
    std::fill(t + rows, t + rows + lanes, Real(0));
    k.front_backward(panel_.data() + f.panel, f.lda, inverse_.data() + 3 * f.first, t, own, rows);
    std::copy(t, t + own, x + 3 * f.first);
  }
}

template <class Real>
void MultifrontalCholesky<Real>::solve(double* x) {
  [[maybe_unused]] const FlushSubnormals<Real> flush;
  e_.permute(x, x_.data());
  forward(x_.data());
  backward(x_.data());
  e_.restore(x_.data(), x);
}

template <class Real>
bool MultifrontalCholesky<Real>::begin_motion(const BlockMatrix* a, const VecX& load, const VecX&) {
  [[maybe_unused]] const FlushSubnormals<Real> flush;
  if (a) ++factor_number_;
  loaded_ = true;
  e_.permute(load.data(), load_.data());
  for (const Front& f : e_.front) {
    if (a && !factorise(*a, f)) return false;
    forward(f, load_.data());
  }
  return true;
}

template <class Real>
void MultifrontalCholesky<Real>::unforced_motion(const VecX&, VecX& x) {
  end_motion({}, nullptr, x);
}

template <class Real>
void MultifrontalCholesky<Real>::end_motion(const BodyRows& rows, const double* lambda, VecX& x) {
  [[maybe_unused]] const FlushSubnormals<Real> flush;
  std::copy_n(load_.data(), 3 * e_.nodes, x_.data());
  if (rows.count() > 0) combine(rows, lambda, x_.data());
  backward(x_.data());
  x.resize(3 * e_.nodes);
  e_.restore(x_.data(), x.data());
}

template class MultifrontalCholesky<double>;
template class MultifrontalCholesky<float>;

}  // namespace insula
