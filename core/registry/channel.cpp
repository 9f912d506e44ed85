// SPDX-License-Identifier: GPL-3.0-or-later
// Checking the declaration of a channel.
#include "core/registry/channel.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "core/registry/component.h"

namespace insula {
namespace {

[[noreturn]] void bad_channel(std::string_view channel, const std::string& why) {
  throw std::logic_error("channel \"" + std::string(channel) + "\" is declared wrongly: " + why);
}

std::optional<double> bound(const ChannelSpec& spec, std::string_view text, const ChannelBase::Quantity& quantity) {
  if (text.empty()) return std::nullopt;
  std::string error;
  const auto value = parse_quantity(text, quantity.units, quantity.name, error);
  if (!value) bad_channel(spec.name, error);
  return value;
}

DisplayedQuantity displayed(const ChannelSpec& spec, const ChannelBase::Quantity& quantity) {
  try {
    return {quantity, spec.display, spec.digits};
  } catch (const std::logic_error& e) {
    bad_channel(spec.name, e.what());
  }
}

}  // namespace

std::string_view shown_name(Shown shown) {
  return shown == Shown::vital ? "vital" : shown == Shown::curve ? "curve" : "none";
}

ChannelBase::ChannelBase(Component* owner, ChannelSpec spec, Quantity quantity, int size, bool single)
    : spec_(spec), displayed_(displayed(spec, quantity)), size_(size), single_(single) {
  if (!owner) bad_channel(spec_.name, "it has no owner");
  if (spec_.name.empty() || spec_.name.find_first_of(". \t") != std::string_view::npos)
    bad_channel(spec_.name, "it needs a name without dots and blanks");
  if (spec_.doc.empty()) bad_channel(spec_.name, "it has no doc");
  for (const ChannelBase* other : owner->channels())
    if (other->spec().name == spec_.name) bad_channel(spec_.name, "the component has it twice");
  min_ = bound(spec_, spec_.min, quantity);
  max_ = bound(spec_, spec_.max, quantity);
  if (min_ && max_ && *min_ > *max_) bad_channel(spec_.name, "its minimum is above its maximum");
  good_ = {bound(spec_, spec_.good.from, quantity), bound(spec_, spec_.good.to, quantity)};
  high_ = {bound(spec_, spec_.high.from, quantity), bound(spec_, spec_.high.to, quantity)};
  if (single_) set_groups({""});
  owner->channels_.push_back(this);
}

std::string ChannelBase::name(std::size_t item) const {
  const std::string own(spec_.name);
  return single_ ? own : groups_[item] + "." + own;
}

void ChannelBase::set_groups(std::vector<std::string> names) {
  groups_ = std::move(names);
  values_.resize(groups_.size() * std::size_t(size_));
  reset();
}

void ChannelBase::reset() { std::fill(values_.begin(), values_.end(), std::numeric_limits<double>::quiet_NaN()); }

int ChannelBase::judged(double si) const {
  const auto some = [](const Bounds& b) { return b[0] || b[1]; };
  const auto within = [&](const Bounds& b) { return some(b) && (!b[0] || si >= *b[0]) && (!b[1] || si <= *b[1]); };
  if (within(good_)) return 1;
  return within(high_) || (!some(good_) && !some(high_)) ? 0 : -1;
}

}  // namespace insula
