// SPDX-License-Identifier: GPL-3.0-or-later
// Results of `insula bench --haptics`, as a table, as medians over many probes, or as JSON.
#pragma once
#include <ostream>
#include <string>
#include <vector>

#include "tools/workbench/haptic_truth.h"

namespace insula {

/// One hand of one probe, rendered in one way, at one rate of the engine.
struct HapticResult {
  double hz = 0;
  std::string rendering;  ///< "servo", "held", "hindsight", or a line of the ablation
  std::string probe;
  int hand = 0;
  TruthOfHand truth;
  double jump_N = 0;
  double rendered_peak_N = 0;  ///< `held`: the largest force of the engine itself
};

/// A line for each result.
void print_table(std::ostream& out, const std::vector<HapticResult>& results);
/// Median and 90th percentile over the probes of each rate, together and by kind (the first word of their names).
void print_percentiles(std::ostream& out, const std::vector<HapticResult>& results);
/// {"rates": [{"hz", "servo": {"rms_pct_p50", "rms_pct_p90"}, "held", "hindsight", "onset_ms_max", "jump_pct_max",
/// "engine_peak_ratio_max", "probes": [{"name", "hand", "peak_N", "engine_peak_N", "servo_pct", "held_pct",
/// "hindsight_pct", "onset_ms", "jump_pct"}]}]}; null where nothing was measured.
std::string haptic_json(const std::vector<HapticResult>& results);

}  // namespace insula
