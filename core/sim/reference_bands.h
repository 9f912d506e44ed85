// SPDX-License-Identifier: GPL-3.0-or-later
// Reference bands in a report: where the metrics of a run lie among those of a group of sessions. The bands come from
// `insula bands --json` (engine/session/bands.h).
#pragma once
#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "core/sim/metric.h"

namespace insula {

/// The middle half of a group, in the metric's unit.
struct ReferenceBand {
  double median = 0, low = 0, high = 0;  ///< low, high: quartiles
  std::optional<double> pass_mark;
  std::string unit;
};

class ReferenceBands {
 public:
  ReferenceBands() = default;  ///< none
  /// group: whose bands; empty: the only one. Throws InputError if the file has no bands or no such group.
  ReferenceBands(const std::filesystem::path& file, const std::string& group);

  bool empty() const { return bands_.empty(); }
  const std::string& title() const { return title_; }  ///< of the exercise whose sessions they are
  const std::string& group() const { return group_; }
  std::size_t sessions() const { return sessions_; }  ///< in the group
  /// The band of a metric, if there is one in its unit.
  const ReferenceBand* find(const MetricValue& metric) const;
  /// The band of a metric and hand ("left", "right", "both"), whatever its unit; null: none.
  const ReferenceBand* of(const std::string& metric, const std::string& hand) const;

 private:
  std::string title_, group_;
  std::size_t sessions_ = 0;
  std::map<std::pair<std::string, std::string>, ReferenceBand> bands_;  ///< by id and hand
};

/// The bands of a file for the exercise of that title. Throws InputError as the constructor, and if they are of another
/// exercise.
ReferenceBands bands_for(const std::filesystem::path& file, const std::string& group, const std::string& title);

/// The bands beside a scene, NAME_bands.json; empty if there are none.
std::filesystem::path bands_beside(const std::filesystem::path& scene);

/// What a distance from the band is measured in: its width, or a twentieth of the median, or one unit. In the metric's
/// unit.
double band_width(const ReferenceBand& band);

/// How far a value lies beyond the middle half on the side that shows less skill, in widths of the half; 0: not beyond.
/// A metric without a better side counts on both.
double beyond_band(const MetricValue& metric, const ReferenceBand& band);

/// The metrics that lie beyond their band, farthest first; at most `most`.
std::vector<const MetricValue*> to_work_on(const std::vector<MetricValue>& metrics, const ReferenceBands& bands,
                                           std::size_t most);

}  // namespace insula
