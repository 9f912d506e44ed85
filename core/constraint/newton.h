// SPDX-License-Identifier: GPL-3.0-or-later
// Nonsmooth Newton method for problems on which Gauss-Seidel stalls: stiff bodies on soft ones, mass ratios of
// thousands, long chains of contacts.
//
// Each block is in one of the pieces of its law, namely the one that its local solution falls into. The pieces are
// those of Alart and Curnier (1991), who linearise the projection of lambda - rho delta:
//   box       at a bound: lambda given         inside: delta + c lambda = 0
//   friction  open: lambda = 0                 sticks: delta + c lambda_n = 0, delta_t = 0
//             slips along u: delta_n + c lambda_n = 0, lambda_t = mu lambda_n u + y v, v . delta_t + s y = 0, s =
//             |delta_t| / |lambda_t|
//   patch     as the tangential part of friction, with the sum of its contacts' lambda
// In the remaining unknowns lambda = lambda0 + T x. They satisfy R (W T x + delta0) + C x = 0, which is solved by LU.
// The result is projected into the bounds of the laws and smoothed by a few sweeps. It is accepted if its residual is
// smaller. Otherwise a shorter step is tried. Finally a stronger proximal term eps W_ii x_i is used, which also makes a
// semidefinite W (redundant contacts) harmless.
#pragma once
#include <span>
#include <vector>

#include "core/constraint/sweep.h"

namespace insula {

/// One unknown. In each of `count` rows, lambda changes by `weight` times x. Its equation is the weighted sum of delta
/// with the weights `test`.
struct NewtonUnknown {
  int count = 0;
  int rows[3] = {};
  double weight[3] = {};
  int tests = 0;
  int test_rows[2] = {};
  double test[2] = {};
  double compliance = 0;  ///< times x, added to its equation
  double offset = 0;      ///< c lambda0 of a compliant row
};

struct NewtonMemory {
  std::vector<NewtonUnknown> unknowns;
  std::vector<int> unknown_of_row, pivots;
  std::vector<double> base, x, trial;
  AlignedVector<double> matrix, row, delta;
  void reserve(int rows);
};

/// The lambda to which a full Newton step leads from lambda (with its delta, padded to the stride), before the bounds
/// are applied. Written to memory.trial. `proximal` is eps above. Returns false if the matrix is singular or has more
/// than max_unknowns rows.
bool newton_target(const ConstraintProblem& problem, std::span<const double> delta_free, const double* lambda,
                   const double* delta, double proximal, int max_unknowns, NewtonMemory& memory);

/// The nearest lambda within the bounds of every law.
void put_into_bounds(const ConstraintProblem& problem, double* lambda);

}  // namespace insula
