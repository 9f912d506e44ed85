// SPDX-License-Identifier: GPL-3.0-or-later
// When each metric became worse fastest: the moment to look at in a replay.
#pragma once
#include <optional>
#include <vector>

#include "core/sim/metric.h"

namespace insula {

class Exercise;

class MetricMoments {
 public:
  /// Called after each step with its time, s; looks at the metrics once a second. Values that become less where more is
  /// better, or more where less is better, have become worse by the difference.
  void observe(double time_s, const Exercise& exercise);
  /// The same with values at hand.
  void observe(double time_s, const std::vector<MetricValue>& metrics);
  /// The end of the second in which the metric became worse by most; none if it never did, or has no better side.
  std::optional<double> worst_s(const MetricValue& metric) const;

 private:
  struct Moment {
    std::string id;
    int hand = 0;
    double value = 0, worst_by = 0, worst_s = 0;
  };
  double next_s_ = 0;
  std::vector<Moment> moments_;  ///< in the order of the metrics
};

}  // namespace insula
