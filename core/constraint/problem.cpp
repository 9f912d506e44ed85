// SPDX-License-Identifier: GPL-3.0-or-later
// Sizes of the constraint problem.
#include "core/constraint/problem.h"

#include "core/constraint/problem_fields.h"

namespace insula {

void ConstraintProblem::resize(int n) {
  rows = n;
  stride = (n + 7) & ~7;
  w.assign(std::size_t(n) * stride, 0.0);
  for_each_field(row_fields, [&](const auto& f, std::size_t) { (this->*f.values).assign(std::size_t(n), 0.0); });
  reduced.clear();
}

}  // namespace insula
