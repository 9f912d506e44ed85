// SPDX-License-Identifier: GPL-3.0-or-later
// How fast an exercise of a case runs on this machine, and how it begins.
#pragma once
#include "tools/case_builder/case_folder.h"
#include "tools/case_builder/standing.h"

namespace insula::case_builder {

/// A scene of the case, loaded as `insula check` does and stepped with the hands still.
struct MeasuredScene {
  std::string file;
  std::string message;                            ///< why it does not load; empty: it does
  double step_ms = 0, max_ms = 0, budget_ms = 0;  ///< median, 95th percentile, of the scene's step
  int nodes = 0, rows = 0;
  bool finite = true;
  Standing standing;  ///< as it begins, before anybody does anything
};
MeasuredScene measure_scene(const fs::path& scene, int steps);

/// Steps of a scene under its first motion in which a clip touches the vessel, until a little after one was let go.
struct MeasuredMotion {
  double step_ms = 0, max_ms = 0;  ///< median, 95th percentile
  int steps = 0, rows = 0;         ///< 0: no clip ever touched the vessel, or the scene has no motion
};
MeasuredMotion measure_motion(const fs::path& scene, double longest_s);

}  // namespace insula::case_builder
