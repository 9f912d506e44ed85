// SPDX-License-Identifier: GPL-3.0-or-later
// The linear system of the laws' pieces, and its solution.
#include "core/constraint/newton.h"

#include <algorithm>
#include <cmath>

#include "core/constraint/dense_lu.h"

namespace insula {

void NewtonMemory::reserve(int rows) {
  const std::size_t n = (std::size_t(rows) + 15) & ~std::size_t(7);
  unknowns.reserve(n);
  unknown_of_row.reserve(n);
  pivots.reserve(n);
  for (std::vector<double>* v : {&base, &x, &trial}) v->reserve(n);
  row.reserve(n);
  delta.reserve(n);
  matrix.reserve(n * n);
}

namespace {

class Pieces {
 public:
  Pieces(const ConstraintProblem& p, const double* lambda, const double* delta, NewtonMemory& m)
      : p_(p), lambda_(lambda), delta_(delta), m_(m) {}

  void collect() {
    m_.unknowns.clear();
    m_.unknown_of_row.assign(std::size_t(p_.rows), -1);
    m_.base.assign(lambda_, lambda_ + p_.rows);
    double next[3];
    for (const Block& b : p_.blocks) {
      local_solution(p_, b, lambda_, delta_, next);
      if (b.law == LawKind::box) box(b, next[0]);
      else if (b.law == LawKind::friction) friction(b, next);
      else patch(b, next);
    }
  }

 private:
  double& base(int row) { return m_.base[std::size_t(row)]; }

  NewtonUnknown& add(int row, double compliance) {
    m_.unknown_of_row[std::size_t(row)] = int(m_.unknowns.size());
    NewtonUnknown& u = m_.unknowns.emplace_back();
    u.count = u.tests = 1;
    u.rows[0] = u.test_rows[0] = row;
    u.weight[0] = u.test[0] = 1;
    u.compliance = compliance;
    return u;
  }

  void box(const Block& b, double next) {
    const double w = p_.w_at(b.row, b.row) + b.compliance;
    if (!(w > 0) || next <= b.lower || next >= b.upper) base(b.row) = next;
    else add(b.row, b.compliance).offset = b.compliance * base(b.row);
  }

  // |slip| / |force| of two tangents after the local solution.
  double slip_rate(int row, int first, int count, const double* next) const {
    double slip[2];
    for (int t = 0; t < 2; ++t) {
      slip[t] = delta_[row + t];
      for (int k = 0; k < count; ++k) slip[t] += p_.w_at(row + t, first + k) * (next[k] - lambda_[first + k]);
    }
    const double* force = next + count - 2;
    return std::hypot(slip[0], slip[1]) / std::hypot(force[0], force[1]);
  }

  // The unknown y along v, perpendicular to the direction u of the force.
  void across(int row, double u0, double u1, double rate) {
    NewtonUnknown& y = m_.unknowns.emplace_back();
    y.count = y.tests = 2;
    y.rows[0] = y.test_rows[0] = row;
    y.rows[1] = y.test_rows[1] = row + 1;
    y.weight[0] = y.test[0] = -u1;
    y.weight[1] = y.test[1] = u0;
    y.compliance = rate;
  }

  static void follow(NewtonUnknown& normal, int row, double share0, double share1) {
    normal.count = 3;
    normal.rows[1] = row;
    normal.rows[2] = row + 1;
    normal.weight[1] = share0;
    normal.weight[2] = share1;
  }

  void friction(const Block& b, const double* next) {
    const int r = b.row;
    if (!(next[0] > 0)) {
      base(r) = base(r + 1) = base(r + 2) = 0;
      return;
    }
    const double size = std::hypot(next[1], next[2]), bound = b.friction * next[0];
    const std::size_t normal = m_.unknowns.size();
    add(r, b.compliance).offset = b.compliance * base(r);
    if (b.friction > 0 && size < bound * (1 - 1e-12)) {
      add(r + 1, 0);
      add(r + 2, 0);
      return;
    }
    if (!(b.friction > 0 && size > 0)) {
      base(r + 1) = base(r + 2) = 0;
      return;
    }
    const double u0 = next[1] / size, u1 = next[2] / size;
    base(r + 1) = b.friction * base(r) * u0;
    base(r + 2) = b.friction * base(r) * u1;
    follow(m_.unknowns[normal], r + 1, b.friction * u0, b.friction * u1);
    across(r + 1, u0, u1, slip_rate(r + 1, r, 3, next));
  }

  void patch(const Block& b, const double* next) {
    const int r = b.row;
    double pressed = 0, bound = 0;
    for (int i = r - b.normals; i < r; ++i) {
      pressed += std::max(0.0, lambda_[i]);
      bound += std::max(0.0, base(i));
    }
    const double size = std::hypot(next[0], next[1]);
    if (!(pressed > 0) || !(size > 0)) {
      base(r) = base(r + 1) = 0;
      return;
    }
    if (size < b.friction * pressed * (1 - 1e-12)) {
      add(r, 0);
      add(r + 1, 0);
      return;
    }
    const double u0 = next[0] / size, u1 = next[1] / size;
    base(r) = b.friction * bound * u0;
    base(r + 1) = b.friction * bound * u1;
    for (int i = r - b.normals; i < r; ++i)
      if (const int k = m_.unknown_of_row[std::size_t(i)]; k >= 0)
        follow(m_.unknowns[std::size_t(k)], r, b.friction * u0, b.friction * u1);
    across(r, u0, u1, slip_rate(r, r, 2, next));
  }

  const ConstraintProblem& p_;
  const double *lambda_, *delta_;
  NewtonMemory& m_;
};

}  // namespace

bool newton_target(const ConstraintProblem& p, std::span<const double> free, const double* lambda, const double* delta,
                   double proximal, int max_unknowns, NewtonMemory& m) {
  const auto combine = sweep_kernels().combine;
  Pieces(p, lambda, delta, m).collect();
  const int count = int(m.unknowns.size());
  if (count > max_unknowns) return false;
  m.trial.assign(m.base.begin(), m.base.end());
  if (count == 0) return true;
  m.delta.assign(std::size_t(p.stride), 0.0);
  std::copy(free.begin(), free.end(), m.delta.begin());
  combine(m.delta.data(), p.w.data(), p.stride, m.base.data(), p.rows, p.stride);
  const long stride = (count + 7) & ~7;
  m.matrix.assign(std::size_t(stride * stride), 0.0);
  m.x.resize(std::size_t(count));
  m.pivots.resize(std::size_t(count));
  for (int i = 0; i < count; ++i) {
    const NewtonUnknown& u = m.unknowns[std::size_t(i)];
    m.row.assign(std::size_t(p.stride), 0.0);
    double rest = u.offset, diagonal = 0;
    for (int a = 0; a < u.tests; ++a) {
      combine(m.row.data(), p.w.data() + std::size_t(u.test_rows[a]) * p.stride, p.stride, &u.test[a], 1, p.stride);
      rest += u.test[a] * m.delta[std::size_t(u.test_rows[a])];
      diagonal = std::max(diagonal, p.w_at(u.test_rows[a], u.test_rows[a]));
    }
    double* out = m.matrix.data() + i * stride;
    for (int j = 0; j < count; ++j) {
      const NewtonUnknown& v = m.unknowns[std::size_t(j)];
      double sum = 0;
      for (int a = 0; a < v.count; ++a) sum += v.weight[a] * m.row[std::size_t(v.rows[a])];
      out[j] = sum;
    }
    out[i] += u.compliance + proximal * diagonal;
    m.x[std::size_t(i)] = -rest;
  }
  if (!lu_factor(m.matrix.data(), count, stride, m.pivots.data(), 1e-14)) return false;
  lu_solve(m.matrix.data(), count, stride, m.pivots.data(), m.x.data());
  for (int j = 0; j < count; ++j) {
    const NewtonUnknown& v = m.unknowns[std::size_t(j)];
    if (!std::isfinite(m.x[std::size_t(j)])) return false;
    for (int a = 0; a < v.count; ++a) m.trial[std::size_t(v.rows[a])] += v.weight[a] * m.x[std::size_t(j)];
  }
  return true;
}

void put_into_bounds(const ConstraintProblem& p, double* lambda) {
  const auto shorten = [](double* t, double bound) {
    const double size = std::hypot(t[0], t[1]);
    if (size <= bound) return;
    const double share = bound > 0 ? bound / size : 0;
    t[0] *= share;
    t[1] *= share;
  };
  for (const Block& b : p.blocks) {
    double* l = lambda + b.row;
    if (b.law == LawKind::box) {
      *l = std::clamp(*l, b.lower, b.upper);
    } else if (b.law == LawKind::friction) {
      *l = std::max(0.0, *l);
      shorten(l + 1, b.friction * *l);
    } else {
      double pressed = 0;
      for (int i = 1; i <= b.normals; ++i) pressed += std::max(0.0, l[-i]);
      shorten(l, b.friction * pressed);
    }
  }
}

}  // namespace insula
