// SPDX-License-Identifier: GPL-3.0-or-later
// A load that turns and grows with the surface on which it acts, such as the pressure of a fluid.
#pragma once
#include "core/linalg/block_matrix.h"

namespace insula {

class FollowerLoad {
 public:
  virtual ~FollowerLoad() = default;
  /// a += scale * d(load)/dq at the present positions, N/m, symmetric; `a` has the pattern of the body's matrix. The
  /// step's matrix takes it with scale -1. Only the convergence to the equilibrium depends on its accuracy.
  virtual void add_gradient(BlockMatrix& a, double scale) const = 0;
};

}  // namespace insula
