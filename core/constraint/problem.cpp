// SPDX-License-Identifier: GPL-3.0-or-later
// Sizes of the constraint problem.
#include "core/constraint/problem.h"

namespace insula {

void ConstraintProblem::resize(int n) {
  rows = n;
  stride = (n + 7) & ~7;
  w.assign(std::size_t(n) * stride, 0.0);
  delta_free.assign(std::size_t(n), 0.0);
  lambda.assign(std::size_t(n), 0.0);
  rate.assign(std::size_t(n), 0.0);
  retardation_time.assign(std::size_t(n), 0.0);
}

}  // namespace insula
