// SPDX-License-Identifier: GPL-3.0-or-later
// The metrics of a run in reports: for programs, for people and for spreadsheets.
#pragma once
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "core/sim/metric.h"
#include "core/sim/reference_bands.h"

namespace insula {

/// With its digits and unit; empty if it is not known.
std::string shown_value(const MetricValue& metric);
/// {id, hand, unit, value, better}, as in metrics_json().
nlohmann::ordered_json metric_json(const MetricValue& metric);
/// [{id, hand: "left" | "right" | "both", unit, value, better: "high" | "low" | "none", digits, text, source}]. An
/// unknown value is null. The source is left out on request.
nlohmann::ordered_json metrics_json(const std::vector<MetricValue>& metrics, bool with_source = true);
/// Adds to each of these values that has one: "band": {group, median, low, high, pass_mark, beyond}.
void add_bands(nlohmann::ordered_json& metrics_json, const std::vector<MetricValue>& metrics,
               const ReferenceBands& bands);
/// A table with a line for each metric and a column for each hand; empty if nothing is known.
std::string metrics_html(const std::vector<MetricValue>& metrics);
/// A line for each value: id,hand,value,unit,better,text. An unknown value is empty.
std::string metrics_csv(const std::vector<MetricValue>& metrics);

}  // namespace insula
