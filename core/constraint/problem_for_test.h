// SPDX-License-Identifier: GPL-3.0-or-later
// W of a problem from and to a dense matrix, for tests.
#pragma once
#include "core/constraint/problem.h"

namespace insula::testing {

/// Sets W of the problem's rows.
template <class Matrix>
void set_w(ConstraintProblem& p, const Matrix& w) {
  for (int i = 0; i < p.rows; ++i)
    for (int j = 0; j < p.rows; ++j) p.w[std::size_t(i) * std::size_t(p.stride) + std::size_t(j)] = w(i, j);
}

inline MatX w_of(const ConstraintProblem& p) {
  return MatX::NullaryExpr(p.rows, p.rows, [&](Eigen::Index i, Eigen::Index j) { return p.w_at(int(i), int(j)); });
}

}  // namespace insula::testing
