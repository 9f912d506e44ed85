// SPDX-License-Identifier: GPL-3.0-or-later
// Values at the nodes of a regular grid, interpolated linearly.
#pragma once
#include <vector>

#include "core/base/math.h"

namespace insula {

/// Trilinear interpolation of `values` (x fastest, n[0] x n[1] x n[2]) at `at`, counted in cells from the first node.
/// Returns `outside` beyond the grid and where `at` is not a number. Source: W. Press et al., Numerical Recipes,
/// section 3.6.
inline double grid_sample(const std::vector<float>& values, const int (&n)[3], const Vec3& at, double outside) {
  int cell[3];
  double part[3];
  for (int a = 0; a < 3; ++a) {
    if (!(at[a] >= 0) || at[a] >= n[a] - 1) return outside;
    cell[a] = int(at[a]), part[a] = at[a] - cell[a];
  }
  double sum = 0;
  for (int corner = 0; corner < 8; ++corner) {
    double weight = 1;
    std::size_t node[3];
    for (int a = 0; a < 3; ++a) {
      const int far = corner >> a & 1;
      weight *= far ? part[a] : 1 - part[a], node[a] = std::size_t(cell[a] + far);
    }
    sum += weight * double(values[(node[2] * std::size_t(n[1]) + node[1]) * std::size_t(n[0]) + node[0]]);
  }
  return sum;
}

}  // namespace insula
