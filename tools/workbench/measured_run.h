// SPDX-License-Identifier: GPL-3.0-or-later
// What every benchmark of a scene does first: it opens the scene with its motion, and steps to the time of interest.
#pragma once
#include "engine/live/headless.h"
#include "tools/workbench/workbench.h"

namespace insula {

/// Opens the scene of `options` with its motion. `steady` may be missing from the scene; another motion may not.
/// Without a simulation in the result, the errors are printed and the exit status is 2.
inline OpenedRun open_for_measuring(const CommandContext& context, const BenchOptions& options) {
  return open_run(context, options.scene, options.motion, options.motion == "steady", options.threads);
}

/// Steps to the time `options.from`, at least five steps, so that caches are warm. `h`: the step, s.
inline void warm_up(HeadlessRun& run, const BenchOptions& options, double h) {
  const auto steps = std::max<std::int64_t>(5, std::int64_t(options.from / h));
  for (std::int64_t k = 0; k < steps; ++k) run.step();
}

}  // namespace insula
