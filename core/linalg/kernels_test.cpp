// SPDX-License-Identifier: GPL-3.0-or-later
// Products with a few columns, of every instruction set the processor has, against plain loops.
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
      auto less = y;
      k.columns_sub(less.data(), a.data(), lda, x.data(), m, n);
      for (int r = 0; r < m; ++r) {
        double sum = double(y[std::size_t(r)]);
        for (int c = 0; c < n; ++c) sum -= double(a[std::size_t(r + c * lda)]) * double(x[std::size_t(c)]);
        ASSERT_NEAR(double(less[std::size_t(r)]), sum, near * n) << m << " x " << n << ", row " << r;
      }
      for (std::size_t r = std::size_t(m + k.width); r < y.size(); ++r) ASSERT_EQ(less[r], y[r]) << "beyond a vector past the end";
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
    }
}

TEST(Kernels, ColumnsTimesAVector) {
  const auto tables = every_table();
  for (const InstructionSet set : {InstructionSet::sse2, InstructionSet::avx2, InstructionSet::avx512}) {
    if (!processor_has(set)) continue;
    check_columns(tables.table[std::size_t(set)]->f64);
    check_columns(tables.table[std::size_t(set)]->f32);
  }
}

}  // namespace
}  // namespace insula
