// SPDX-License-Identifier: GPL-3.0-or-later
#include "haptic_server/newton_budget.h"

#include <chrono>
#include <vector>

#include "core/constraint/aligned.h"
#include "core/constraint/dense_lu.h"

namespace insula {

double factorisation_time(int unknowns) {
  const long n = unknowns, stride = (n + 7) & ~7L;
  AlignedVector<double> whole(std::size_t(n * stride), 0.0), matrix;
  for (long i = 0; i < n; ++i)
    for (long j = 0; j < n; ++j)
      whole[std::size_t(i * stride + j)] = 1.0 / double(1 + (i - j) * (i - j));  // positive definite and full
  std::vector<int> pivots(std::size_t(n), 0);
  double min_s = 1;
  for (int k = 0; k < 8; ++k) {
    matrix = whole;
    const auto start = std::chrono::steady_clock::now();
    lu_factor(matrix.data(), int(n), stride, pivots.data(), 1e-14);
    min_s = std::min(min_s, std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count());
  }
  return min_s;
}

}  // namespace insula
