// SPDX-License-Identifier: GPL-3.0-or-later
// LU with partial pivoting of a dense, row-major matrix that is not symmetric, in the caller's memory.
#pragma once

namespace insula {

/// In place: L without its unit diagonal below the diagonal, U on and above it. `stride` is a multiple of 8 and at
/// least n. The content of the padding does not matter. pivots[k] is the row that step k was exchanged with. Returns
/// false when a pivot is at most `floor` times the largest entry.
bool lu_factor(double* a, int n, long stride, int* pivots, double floor);
/// x = A^-1 x.
void lu_solve(const double* a, int n, long stride, const int* pivots, double* x);

}  // namespace insula
