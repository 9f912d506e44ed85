// SPDX-License-Identifier: GPL-3.0-or-later
// What a debrief says of a run beside its goals and curves: what to work on, and how it compares with earlier runs of
// the same person. The texts are ready to be shown, so the report and the recording say the same.
#pragma once
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "core/sim/metric.h"
#include "core/sim/reference_bands.h"
#include "engine/reports/metric_moments.h"
#include "engine/reports/own_runs.h"

namespace insula {

struct Review {
  /// A metric beyond its band. low, high: of the band.
  struct Thing {
    std::string text, value, low, high;
    std::optional<double> worst_s;  ///< moment of the pass at which it became worse most
  };
  /// A line of the comparison.
  struct Line {
    std::string text, now, last, best;
    int change = 0;  ///< since the last run: 1 better, -1 worse, 0 the same or neither
  };
  std::string group;         ///< of the bands; empty: there are none
  std::size_t sessions = 0;  ///< of the group
  std::vector<Thing> to_work_on = {};
  std::size_t earlier_runs = 0;
  std::vector<Line> comparison = {};  ///< empty: there is no earlier run
};

/// now: this run.
Review review_of(const std::vector<MetricValue>& metrics, const ReferenceBands& bands, const MetricMoments& moments,
                 const OwnRuns& earlier, const OwnRun& now);

/// Two sections, each left out when nothing is known.
std::string review_html(const Review& review);
/// {group, sessions, to_work_on: [{text, value, low, high, worst_s | null}], earlier_runs,
/// comparison: [{text, now, last, best, change}]}.
nlohmann::ordered_json review_json(const Review& review);
/// The same for a recording, as text: {pass, review}. pass: its number in the recording.
std::string review_message(int pass, const Review& review);

}  // namespace insula
