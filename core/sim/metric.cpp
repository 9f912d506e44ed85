// SPDX-License-Identifier: GPL-3.0-or-later
// Checking the declaration of a metric.
#include "core/sim/metric.h"

#include <limits>
#include <stdexcept>

namespace insula {
namespace {

[[noreturn]] void bad_metric(const std::string& metric, const std::string& why) {
  throw std::logic_error("metric \"" + metric + "\" is declared wrongly: " + why);
}

DisplayedQuantity displayed_as(const MetricSpec& spec, const DisplayedQuantity::Quantity& quantity) {
  try {
    return {quantity, spec.display, spec.digits};
  } catch (const std::logic_error& e) {
    bad_metric(spec.name, e.what());
  }
}

}  // namespace

std::string_view better_name(Better better) {
  return better == Better::low ? "low" : better == Better::high ? "high" : "none";
}

std::string_view hand_name(int hand) { return hand == left_hand ? "left" : hand == right_hand ? "right" : "both"; }

MetricBase::MetricBase(MetricSet* owner, MetricSpec spec, DisplayedQuantity::Quantity quantity, bool single)
    : spec_(std::move(spec)), displayed_(displayed_as(spec_, quantity)), single_(single) {
  if (!owner) bad_metric(spec_.name, "it has no owner");
  if (spec_.name.empty() || spec_.name.find_first_of(" \t") != std::string::npos)
    bad_metric(spec_.name, "it needs a name without blanks");
  if (spec_.doc.empty()) bad_metric(spec_.name, "it has no doc");
  if (spec_.source.empty()) bad_metric(spec_.name, "it has no source");
  for (const MetricBase* other : owner->metrics())
    if (other->spec().name == spec_.name) bad_metric(spec_.name, "the component has it twice");
  if (single_) set_items({""});
  owner->metrics_.push_back(this);
}

std::string MetricBase::id(std::size_t item) const { return single_ ? spec_.name : spec_.name + "." + items_[item]; }

void MetricBase::set_items(std::vector<std::string> names) {
  items_ = std::move(names);
  values_.resize(items_.size());
  reset();
}

void MetricBase::reset() {
  for (auto& v : values_) v.fill(std::numeric_limits<double>::quiet_NaN());
}

}  // namespace insula
