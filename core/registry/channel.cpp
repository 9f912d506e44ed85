// SPDX-License-Identifier: GPL-3.0-or-later
// Checking the declaration of a channel.
#include "core/registry/channel.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
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

}  // namespace

std::string_view shown_name(Shown shown) {
  return shown == Shown::vital ? "vital" : shown == Shown::curve ? "curve" : "none";
}

ChannelBase::ChannelBase(Component* owner, ChannelSpec spec, Quantity quantity, int size, bool single)
    : spec_(spec), quantity_(quantity), size_(size), single_(single) {
  if (!owner) bad_channel(spec_.name, "it has no owner");
  if (spec_.name.empty() || spec_.name.find_first_of(". \t") != std::string_view::npos)
    bad_channel(spec_.name, "it needs a name without dots and blanks");
  if (spec_.doc.empty()) bad_channel(spec_.name, "it has no doc");
  for (const ChannelBase* other : owner->channels())
    if (other->spec().name == spec_.name) bad_channel(spec_.name, "the component has it twice");
  min_ = bound(spec_, spec_.min, quantity_);
  max_ = bound(spec_, spec_.max, quantity_);
  if (min_ && max_ && *min_ > *max_) bad_channel(spec_.name, "its minimum is above its maximum");
  good_ = {bound(spec_, spec_.good.from, quantity_), bound(spec_, spec_.good.to, quantity_)};
  high_ = {bound(spec_, spec_.high.from, quantity_), bound(spec_, spec_.high.to, quantity_)};
  if (spec_.display == "%" && quantity_.units.empty()) {
    scale_ = 100;
  } else if (!spec_.display.empty()) {
    const auto unit = std::find_if(quantity_.units.begin(), quantity_.units.end(),
                                   [&](const Unit& u) { return u.symbol == spec_.display; });
    if (unit == quantity_.units.end())
      bad_channel(spec_.name, "\"" + std::string(spec_.display) + "\" is no unit of " + std::string(quantity_.name));
    scale_ = 1 / unit->to_si;
  }
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

std::string_view ChannelBase::display_unit() const { return spec_.display.empty() ? quantity_.si : spec_.display; }

std::string ChannelBase::text(double si) const {
  if (!std::isfinite(si)) return "unknown";
  char number[64];
  std::snprintf(number, sizeof number, "%.*f", spec_.digits, si * scale_);
  std::string out = number;
  if (out.find_first_not_of("-0.") == std::string::npos && out.front() == '-') out.erase(0, 1);
  return display_unit().empty() ? out : out + " " + std::string(display_unit());
}

}  // namespace insula
