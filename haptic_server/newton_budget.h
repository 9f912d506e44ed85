// SPDX-License-Identifier: GPL-3.0-or-later
// How large a Newton step this machine makes within a tick.
#pragma once
#include <algorithm>
#include <cmath>

namespace insula {

/// Of so many unknowns, whose factorisation takes `took_s`, as many as take `budget_s`: the cost is their cube.
inline int unknowns_within(double budget_s, int unknowns, double took_s) {
  if (!(took_s > 0)) return unknowns;
  return int(unknowns * std::min(1.0, std::cbrt(std::max(0.0, budget_s) / took_s)));
}

/// Shortest of some factorisations of a dense matrix of so many unknowns here and now, s. Takes some milliseconds and
/// allocates.
double factorisation_time(int unknowns);

}  // namespace insula
