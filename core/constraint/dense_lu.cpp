// SPDX-License-Identifier: GPL-3.0-or-later
// Panels of 16 columns. The columns right of a panel are updated with its 16 rows at once.
#include "core/constraint/dense_lu.h"

#include <algorithm>
#include <cmath>

#include "core/constraint/sweep.h"

namespace insula {
namespace {

constexpr int panel = 16;

// Factorises one panel of columns with all rows below its first. Whole rows are exchanged.
bool factor_panel(double* a, int n, long s, int first, int end, int* pivots, double least) {
  for (int k = first; k < end; ++k) {
    int best = k;
    for (int i = k + 1; i < n; ++i)
      if (std::abs(a[i * s + k]) > std::abs(a[best * s + k])) best = i;
    pivots[k] = best;
    if (!(std::abs(a[best * s + k]) > least)) return false;
    if (best != k) std::swap_ranges(a + k * s, a + k * s + n, a + best * s);
    const double inverse = 1 / a[k * s + k];
    for (int i = k + 1; i < n; ++i) {
      const double l = a[i * s + k] *= inverse;
      if (l == 0) continue;
      for (int j = k + 1; j < end; ++j) a[i * s + j] -= l * a[k * s + j];
    }
  }
  return true;
}

}  // namespace

bool lu_factor(double* a, int n, long s, int* pivots, double floor) {
  double largest = 0;
  for (int i = 0; i < n; ++i)
    for (int j = 0; j < n; ++j) largest = std::max(largest, std::abs(a[i * s + j]));
  const auto combine = sweep_kernels().combine;
  for (int first = 0; first < n; first += panel) {
    const int end = std::min(n, first + panel);
    if (!factor_panel(a, n, s, first, end, pivots, floor * largest)) return false;
    if (end == n) break;
    const int width = (n - end + 7) & ~7;
    double minus[panel];
    for (int i = first + 1; i < n; ++i) {
      const int known = std::min(i - first, end - first);
      for (int k = 0; k < known; ++k) minus[k] = -a[i * s + first + k];
      combine(a + i * s + end, a + first * s + end, s, minus, known, width);
    }
  }
  return true;
}

void lu_solve(const double* a, int n, long s, const int* pivots, double* x) {
  for (int k = 0; k < n; ++k) std::swap(x[k], x[pivots[k]]);
  for (int i = 1; i < n; ++i) {
    double sum = x[i];
    for (int j = 0; j < i; ++j) sum -= a[i * s + j] * x[j];
    x[i] = sum;
  }
  for (int i = n - 1; i >= 0; --i) {
    double sum = x[i];
    for (int j = i + 1; j < n; ++j) sum -= a[i * s + j] * x[j];
    x[i] = sum / a[i * s + i];
  }
}

}  // namespace insula
