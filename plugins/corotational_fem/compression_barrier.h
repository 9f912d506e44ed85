// SPDX-License-Identifier: GPL-3.0-or-later
// The compression barrier of one element. Its energy density is the sum of k/2 (s0 - s)^2 over the principal stretches
// s < s0.
#pragma once
#include "core/base/math.h"
#include "core/linalg/block_matrix.h"
#include "plugins/corotational_fem/element_batch.h"

namespace insula {

struct BarrierLaw {
  double stiffness;        ///< k, Pa
  double barrier_stretch;  ///< s0
};

inline Mat3 matrix_of_lane(const double m[9][batch_lanes], int l) {
  Mat3 out;
  for (int i = 0; i < 9; ++i) out(i / 3, i % 3) = m[i][l];
  return out;
}
inline Vec3 rest_gradient(const ElementBatch& e, int l, int node) {
  const auto b = [&](int k) { return Vec3(e.b[k][0][l], e.b[k][1][l], e.b[k][2][l]); };
  if (node > 0) return b(node - 1);
  return -(b(0) + b(1) + b(2));
}

/// Adds the element's force, and its tangent if `stiffness` is given. `positive`: sets negative eigenvalues to zero.
void stiffen(const ElementBatch& e, const ElementWork& work, int lane, const BarrierLaw& law, double* force,
             BlockMatrix* stiffness, double scale, bool positive);
double barrier_energy(const ElementBatch& e, const ElementWork& work, int lane, const BarrierLaw& law);

}  // namespace insula
