// SPDX-License-Identifier: GPL-3.0-or-later
// The largest Newton step that this machine computes within a tick.
#pragma once
#include <algorithm>
#include <cmath>

namespace insula {

/// Number of unknowns whose factorisation takes `budget_s`, if that of `unknowns` takes `took_s`. The cost grows with
/// the cube.
inline int unknowns_within(double budget_s, int unknowns, double took_s) {
  if (!(took_s > 0)) return unknowns;
  return int(unknowns * std::min(1.0, std::cbrt(std::max(0.0, budget_s) / took_s)));
}

/// Shortest measured time of a few factorisations of a dense matrix of that size, s. Takes some milliseconds and
/// allocates.
double factorisation_time(int unknowns);

}  // namespace insula
