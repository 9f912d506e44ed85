// SPDX-License-Identifier: GPL-3.0-or-later
// LU with partial pivoting of a dense, row-major matrix that is not symmetric, in memory of the caller.
#pragma once

namespace insula {

/// In place: L without its unit diagonal below, U on and above it. `stride` is a multiple of 8 and at least n rounded
/// up to one; the padding's content does not matter. pivots[k] is the row that step k was exchanged with. Returns false
/// when a pivot is not above `floor` times the largest entry.
bool lu_factor(double* a, int n, long stride, int* pivots, double floor);
/// x = A^-1 x.
void lu_solve(const double* a, int n, long stride, const int* pivots, double* x);

}  // namespace insula
