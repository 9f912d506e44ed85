// SPDX-License-Identifier: GPL-3.0-or-later
// Reference bands: how the metrics of groups of sessions are distributed, and which metrics tell the groups apart.
#pragma once
#include <cstdint>
#include <map>
#include <string>
#include <utility>
#include <vector>

namespace insula {

/// One session in a group.
struct BandSession {
  std::string group;
  std::string person;  ///< empty: not known, a person of its own
  struct Value {
    std::string unit, better;
    double value = 0;
  };
  std::map<std::pair<std::string, std::string>, Value> metrics;  ///< by id and hand
};

struct GroupBand {
  std::string group;
  std::size_t sessions = 0;
  double mean = 0, deviation = 0;                      ///< sample standard deviation; 0 for one session
  double median = 0, median_low = 0, median_high = 0;  ///< with its 95 % interval by bootstrap
  std::map<double, double> quantiles;                  ///< by share: 0.05, 0.25, 0.75, 0.95
};

struct MetricBand {
  std::string id, hand, unit, better;
  std::vector<GroupBand> groups;  ///< by name; those with values
  /// Cohen's d with Hedges' correction of the second group against the first, for two groups; eta squared, the share of
  /// the variance between groups, for more. NaN: fewer than two values in a group, or no variance.
  double effect = 0;
  /// Share of the sessions whose group is that of the nearest group mean, computed without them.
  double leave_one_out = 0;
  double chance = 0;     ///< share of the largest group
  double pass_mark = 0;  ///< NaN: none is asked for
};

struct PassMark {
  std::string group = {};  ///< empty: none
  double share = -1;       ///< quantile of the group; negative: its mean
};

/// In order of id and hand. The same input gives the same bits.
std::vector<MetricBand> bands(const std::vector<BandSession>& sessions, const PassMark& pass);
/// "experts: 4 persons; bands of fewer than 10 say little", for each group.
std::vector<std::string> band_warnings(const std::vector<BandSession>& sessions);

/// Quantile by linear interpolation between order statistics (Hyndman and Fan 1996, type 7). `sorted` must not be
/// empty.
double quantile(const std::vector<double>& sorted, double share);

}  // namespace insula
