// SPDX-License-Identifier: GPL-3.0-or-later
// Forces of a problem on the hands, for tests that compare a condensed problem with the full one.
#pragma once
#include <array>

#include "core/constraint/solve.h"

namespace insula::testing {

using Wrenches = std::array<Vec6, 2>;

/// Wrenches on the hands by equation 7 with the devices displaced by d, tool by tool.
inline Wrenches hand_wrenches(const ConstraintProblem& p, const Wrenches& d, const SolveSettings& settings) {
  std::vector<double> free = p.delta_free;
  for (std::size_t t = 0; t < p.tools.size(); ++t) {
    const VecX more = p.tools[t].jacobian * (p.tools[t].gain * d[t]);
    for (int i = 0; i < p.rows; ++i) free[std::size_t(i)] += more[i];
  }
  SolveWorkspace ws;
  ws.reserve(p.rows);
  ws.lambda = p.lambda;
  solve(p, free, settings, ws);
  Wrenches out{Vec6::Zero(), Vec6::Zero()};
  for (std::size_t t = 0; t < p.tools.size(); ++t) {
    const ToolTerms& tool = p.tools[t];
    const Vec6 push = tool.jacobian.transpose() * Eigen::Map<const VecX>(ws.lambda.data(), p.rows);
    out[t] = tool.stiffness * displacement(displaced(tool.device, d[t]),
                                           displaced(tool.free, tool.gain * d[t] + tool.compliance * push));
  }
  return out;
}

}  // namespace insula::testing
