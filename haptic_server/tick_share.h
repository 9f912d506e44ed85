// SPDX-License-Identifier: GPL-3.0-or-later
// The share of a viscous row's compliance over a step that acts within a tick.
#pragma once
#include <cmath>

namespace insula {

/// Square root of s = dt / (beta + dt) * (h + beta) / h (substep_correction.h), with a tick of dt, a step of h and the
/// retardation time beta, s. W of a tick is W of the step times the shares of row and column.
inline double tick_share(double dt_s, double h_s, double beta_s) {
  return std::sqrt(dt_s / (beta_s + dt_s) * (h_s + beta_s) / h_s);
}

}  // namespace insula
