// SPDX-License-Identifier: GPL-3.0-or-later
// The direct solver in the requested precision.
#include "core/linalg/direct_solver.h"

#include "core/linalg/block_cholesky.h"

namespace insula {

std::unique_ptr<BodySolver> make_direct_solver(bool single) {
  if (single) return std::make_unique<MultifrontalCholesky<float>>();
  return std::make_unique<MultifrontalCholesky<double>>();
}

}  // namespace insula
