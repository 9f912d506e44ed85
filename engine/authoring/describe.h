// SPDX-License-Identifier: GPL-3.0-or-later
// Descriptions of what a component declares, shared by list, describe, schema and docs.
#pragma once
#include <string>
#include <vector>

#include "core/registry/registry.h"
#include "core/sim/metric.h"

namespace insula {

/// "1 Pa to 1 GPa", "at least 1 Pa", "left, right", or empty.
std::string allowed_text(const ParamBase& param);
/// "2100 Pa", "(required)", "(none)".
std::string default_text(const ParamBase& param);
/// "directly in <scene>", "in a body: <obstacle>, <soft_body>".
std::string place_text(const Registry& registry, const ComponentInfo& info);
/// Elements that may be children of a component of that kind, ordered by kind and name.
std::vector<const ComponentInfo*> children_of_kind(const Registry& registry, Kind parent);
/// Name of a channel as declared: "<name>.flow" for one channel of each name of a group.
std::string channel_name(const ChannelBase& channel);
/// "pressure in mmHg, 0 mmHg to 300 mmHg", "force in N, three numbers".
std::string channel_text(const ChannelBase& channel);
/// The metrics that a component declares; none if it is no MetricSet.
std::vector<const MetricBase*> metrics_of(const Component& component);
/// "path_length", "tissue_time.<name>" for one metric of each name of a group.
std::string metric_name(const MetricBase& metric);
/// "length in mm, of each hand, less is better".
std::string metric_text(const MetricBase& metric);
/// "polylines of arachnoid".
std::string drawable_text(const DrawableBase& drawable);
/// The units as an author may write them, "Pa, kPa, MPa, mmHg", or empty.
std::string units_text(const ParamBase& param);

}  // namespace insula
