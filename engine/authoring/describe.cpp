// SPDX-License-Identifier: GPL-3.0-or-later
// Descriptions of what a component declares.
#include "engine/authoring/describe.h"

#include <algorithm>

#include "core/base/text.h"
#include "core/params/number.h"
#include "core/scene/place_text.h"

namespace insula {

std::string allowed_text(const ParamBase& param) {
  const auto& spec = param.spec();
  if (!spec.choices.empty()) return joined({spec.choices.begin(), spec.choices.end()});
  const std::string min(spec.min), max(spec.max);
  if (!min.empty() && !max.empty()) return min + " to " + max;
  if (!min.empty()) return "at least " + min;
  if (!max.empty()) return "at most " + max;
  return {};
}

std::string default_text(const ParamBase& param) {
  if (param.required()) return "(required)";
  const std::string text(*param.spec().fallback);
  return text.empty() ? "(none)" : text;
}

std::string channel_name(const ChannelBase& channel) {
  return (channel.single() ? "" : "<name>.") + std::string(channel.spec().name);
}

std::string channel_text(const ChannelBase& channel) {
  std::string out(channel.quantity().name);
  if (!channel.display_unit().empty()) out += " in " + std::string(channel.display_unit());
  const std::string min(channel.spec().min), max(channel.spec().max);
  if (!min.empty() && !max.empty()) out += ", " + min + " to " + max;
  else if (!min.empty()) out += ", at least " + min;
  else if (!max.empty()) out += ", at most " + max;
  if (channel.spec().measure) out += ", measure of the exercise";
  return channel.size() == 3 ? out + ", three numbers" : out;
}

std::vector<const MetricBase*> metrics_of(const Component& component) {
  const auto* set = dynamic_cast<const MetricSet*>(&component);
  return set ? std::vector<const MetricBase*>(set->metrics().begin(), set->metrics().end())
             : std::vector<const MetricBase*>();
}

std::string metric_name(const MetricBase& metric) { return metric.spec().name + (metric.single() ? "" : ".<name>"); }

std::string metric_text(const MetricBase& metric) {
  std::string out(metric.displayed().quantity().name);
  if (!metric.displayed().unit().empty()) out += " in " + std::string(metric.displayed().unit());
  out += metric.spec().of == Of::each_hand ? ", of each hand" : ", of both hands";
  if (metric.spec().better == Better::low) out += ", less is better";
  if (metric.spec().better == Better::high) out += ", more is better";
  return out;
}

std::string drawable_text(const DrawableBase& drawable) {
  return std::string(drawable_kind_name(drawable.kind())) + " of " + drawable.material();
}

std::string units_text(const ParamBase& param) { return unit_list(param.units()); }

std::vector<const ComponentInfo*> children_of_kind(const Registry& registry, Kind parent) {
  std::vector<const ComponentInfo*> out;
  for (const auto* info : registry.all())
    if (std::find(info->parents.begin(), info->parents.end(), parent) != info->parents.end()) out.push_back(info);
  return out;
}

std::string place_text(const Registry& registry, const ComponentInfo& info) {
  if (info.kind == Kind::scene) return "the root of a scene file";
  return joined(place_texts(registry, info, [](const auto& names) { return ": " + joined(names); }), "; ");
}

}  // namespace insula
