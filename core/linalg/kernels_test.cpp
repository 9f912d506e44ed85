// SPDX-License-Identifier: GPL-3.0-or-later
// Products with a few columns and substitution with one front, of every instruction set the processor has, against
// plain loops.
#include "core/linalg/kernels.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>
#include <vector>

#include "core/linalg/instruction_set.h"

namespace insula {
INSULA_TABLES(KernelSet, table)
namespace {

template <class Real>
void check_columns(const KernelsOf<Real>& k) {
  SCOPED_TRACE(std::string(k.name) + (sizeof(Real) == 4 ? ", single" : ", double"));
  std::mt19937 dice(7);
  std::uniform_real_distribution<Real> any(-1, 1);
  const auto numbers = [&](std::size_t n) {
    std::vector<Real> v(n);
    for (Real& x : v) x = any(dice);
    return v;
  };
  const double near = 64 * double(std::numeric_limits<Real>::epsilon());
  for (const int m : {0, 1, 3, 7, 8, 9, 16, 21, 45, 130})
    for (const int n : {1, 3, 6, 9, 12, 15, 17}) {
      const long lda = m + 5;
      const auto a = numbers(std::size_t(lda) * std::size_t(n) + 64);
      const auto x = numbers(std::size_t(n));
      const auto y = numbers(std::size_t(m) + 64);
      auto padded = y;
      std::fill(padded.begin() + m, padded.begin() + m + k.width, Real(0));
      std::vector<Real> out(std::size_t(n) + 1, Real(5));
      k.columns_dot(out.data(), a.data(), lda, padded.data(), m, n);
      for (int c = 0; c < n; ++c) {
        double sum = 0;
        for (int r = 0; r < m; ++r) sum += double(a[std::size_t(r + c * lda)]) * double(y[std::size_t(r)]);
        ASSERT_NEAR(double(out[std::size_t(c)]), sum, near * std::sqrt(m + 1.0)) << m << " x " << n << ", column " << c;
      }
      EXPECT_EQ(out.back(), Real(5));
      auto less = y;
      k.columns_sub(less.data(), a.data(), lda, x.data(), m, n);
      for (int r = 0; r < m; ++r) {
        double sum = double(y[std::size_t(r)]);
        for (int c = 0; c < n; ++c) sum -= double(a[std::size_t(r + c * lda)]) * double(x[std::size_t(c)]);
        ASSERT_NEAR(double(less[std::size_t(r)]), sum, near * std::sqrt(n + 1.0)) << m << " x " << n << ", row " << r;
      }
    }
}

// A panel as a factorisation leaves it, its columns padded by numbers that must not matter.
template <class Real>
void check_front(const KernelsOf<Real>& k) {
  SCOPED_TRACE(std::string(k.name) + (sizeof(Real) == 4 ? ", single" : ", double"));
  std::mt19937 dice(11);
  std::uniform_real_distribution<Real> any(-1, 1);
  const double near = 64 * double(std::numeric_limits<Real>::epsilon());
  for (const int own : {3, 6, 9, 15, 24})
    for (const int below : {0, 3, 6, 21, 60}) {
      const int rows = own + below, lda = rows + 5;
      std::vector<Real> l(std::size_t(lda) * std::size_t(own) + 64), inverse, t(std::size_t(rows) + 64);
      for (Real& x : l) x = any(dice);
      for (Real& x : t) x = any(dice);
      for (int c = 0; c < own; ++c) {
        Real& d = l[std::size_t(c + c * lda)];
        d = 4 + d;
        inverse.push_back(1 / d);
      }
      const auto at = [&](int r, int c) { return double(l[std::size_t(r + c * lda)]); };
      std::vector<double> down(t.begin(), t.begin() + rows), up = down;
      for (int c = 0; c < own; ++c) {
        down[std::size_t(c)] /= at(c, c);
        for (int r = c + 1; r < rows; ++r) down[std::size_t(r)] -= at(r, c) * down[std::size_t(c)];
      }
      for (int c = own - 1; c >= 0; --c) {
        for (int r = c + 1; r < rows; ++r) up[std::size_t(c)] -= at(r, c) * up[std::size_t(r)];
        up[std::size_t(c)] /= at(c, c);
      }
      auto forward = t, backward = t;
      k.front_forward(l.data(), lda, inverse.data(), forward.data(), own, rows);
      std::fill(backward.begin() + rows, backward.begin() + rows + k.width, Real(0));
      k.front_backward(l.data(), lda, inverse.data(), backward.data(), own, rows);
      for (int r = 0; r < rows; ++r) {
        ASSERT_NEAR(double(forward[std::size_t(r)]), down[std::size_t(r)], near)
            << own << " columns, row " << r << " of " << rows;
        ASSERT_NEAR(double(backward[std::size_t(r)]), up[std::size_t(r)], near)
            << own << " columns, row " << r << " of " << rows;
      }
      for (std::size_t r = std::size_t(rows + k.width); r < t.size(); ++r)
        ASSERT_EQ(forward[r], t[r]) << "beyond a vector past the end";
    }
}

template <class Check>
void of_every_set(Check&& check) {
  const auto tables = every_table();
  for (const InstructionSet set : {InstructionSet::sse2, InstructionSet::avx2, InstructionSet::avx512})
    if (processor_has(set)) check(*tables.table[std::size_t(set)]);
}

TEST(Kernels, ColumnsTimesAVector) {
  of_every_set([](const KernelSet& t) {
    check_columns(t.f64);
    check_columns(t.f32);
  });
}

TEST(Kernels, SubstitutionWithOneFront) {
  of_every_set([](const KernelSet& t) {
    check_front(t.f64);
    check_front(t.f32);
  });
}

}  // namespace
}  // namespace insula
