// SPDX-License-Identifier: GPL-3.0-or-later
// The product of two vectors as the triangular solves want it.
#pragma once

namespace insula {

/// Eight sums side by side: one alone would wait for each addition. The same bits on every processor.
template <class Real>
Real dot(const Real* a, const Real* b, int n) {
  Real sum[8] = {};
  int i = 0;
  for (; i + 8 <= n; i += 8)
    for (int q = 0; q < 8; ++q) sum[q] += a[i + q] * b[i + q];
  Real rest = 0;
  for (; i < n; ++i) rest += a[i] * b[i];
  return (((sum[0] + sum[1]) + (sum[2] + sum[3])) + ((sum[4] + sum[5]) + (sum[6] + sum[7]))) + rest;
}

}  // namespace insula
