// SPDX-License-Identifier: GPL-3.0-or-later
// Channels of a run, collected and written.
#include "engine/reports/channel_record.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "core/base/spoken.h"
#include "engine/reports/svg_plot.h"

namespace insula {

void ChannelRecord::Figures::add(double v) {
  last = v;
  if (!std::isfinite(v)) return;
  min = steps == 0 ? v : std::min(min, v);
  max = steps == 0 ? v : std::max(max, v);
  sum += v;
  ++steps;
}

void ChannelRecord::begin(const ChannelTable& table, std::size_t most) {
  begun_ = true;
  for (const ChannelEntry& e : table.entries()) {
    const ChannelBase& c = *e.channel;
    Known k{e.id,
            e.component->id,
            e.group(),
            std::string(c.spec().name),
            std::string(c.quantity().si),
            std::string(c.display_unit()),
            c.display_scale(),
            c.spec().digits,
            e.size(),
            c.spec().shown,
            e.offset,
            -1};
    if (k.shown != Shown::none && k.size == 1) {
      k.curve = int(curve_offset_.size());
      curve_offset_.push_back(k.offset);
    }
    known_.push_back(std::move(k));
  }
  figures_.resize(table.numbers());
  samples_.reserve(most * curve_offset_.size());
}

void ChannelRecord::observe(const std::vector<double>& values) {
  for (std::size_t i = 0; i < figures_.size() && i < values.size(); ++i) figures_[i].add(values[i]);
}

void ChannelRecord::push(const std::vector<double>& values) {
  for (std::size_t offset : curve_offset_) samples_.push_back(float(values[offset]));
}

void ChannelRecord::replace_last(const std::vector<double>& values) {
  const std::size_t n = curve_offset_.size();
  if (samples_.size() < n) return;
  for (std::size_t k = 0; k < n; ++k) samples_[samples_.size() - n + k] = float(values[curve_offset_[k]]);
}

void ChannelRecord::halve(std::size_t samples) {
  const std::size_t n = curve_offset_.size();
  for (std::size_t i = 0; i < samples / 2; ++i)
    std::copy_n(samples_.begin() + std::ptrdiff_t((2 * i + 1) * n), n, samples_.begin() + std::ptrdiff_t(i * n));
  samples_.resize(samples / 2 * n);
}

nlohmann::ordered_json ChannelRecord::json() const {
  using Json = nlohmann::ordered_json;
  Json out = Json::object();
  for (const Known& c : known_) {
    const auto figure = [&](auto get) {
      Json all = Json::array();
      for (int k = 0; k < c.size; ++k) {
        const Figures& f = figures(c, k);
        const double v = f.steps > 0 ? get(f) : std::nan("");
        all.push_back(std::isfinite(v) ? Json(v) : Json());
      }
      return c.size == 1 ? Json(all.at(0)) : all;
    };
    out[c.id] = {{"unit", c.unit},
                 {"min", figure([](const Figures& f) { return f.min; })},
                 {"max", figure([](const Figures& f) { return f.max; })},
                 {"mean", figure([](const Figures& f) { return f.sum / double(f.steps); })},
                 {"last", figure([](const Figures& f) { return f.last; })}};
  }
  return out;
}

std::string ChannelRecord::html() const {
  std::string out;
  for (std::size_t i = 0; i < known_.size(); ++i) {
    const std::string& component = known_[i].component;
    if (i > 0 && known_[i - 1].component == component) continue;
    // Columns are the component's kinds of channel, rows its groups.
    std::vector<const Known*> vital;
    std::vector<std::string> groups, names;
    for (const Known& k : known_)
      if (k.component == component && k.shown == Shown::vital && k.size == 1) vital.push_back(&k);
    if (vital.empty()) continue;
    for (const Known* k : vital) {
      if (std::find(groups.begin(), groups.end(), k->group) == groups.end()) groups.push_back(k->group);
      if (std::find(names.begin(), names.end(), k->name) == names.end()) names.push_back(k->name);
    }
    out += fmt::format("<h2>{} at the end</h2>\n<table><thead><tr><th></th>", escaped(spoken(component)));
    for (const std::string& name : names) {
      const auto first = std::find_if(vital.begin(), vital.end(), [&](const Known* k) { return k->name == name; });
      out += fmt::format("<th class=\"n\">{}{}</th>", escaped(spoken(name)),
                         (*first)->display_unit.empty() ? "" : escaped(" (" + (*first)->display_unit + ")"));
    }
    out += "</tr></thead><tbody>\n";
    for (const std::string& group : groups) {
      out += fmt::format("<tr><td>{}</td>", escaped(spoken(group)));
      for (const std::string& name : names) {
        const auto at = std::find_if(vital.begin(), vital.end(),
                                     [&](const Known* k) { return k->name == name && k->group == group; });
        const double v = at == vital.end() ? std::nan("") : figures(**at).last * (*at)->scale;
        out +=
            std::isfinite(v) ? fmt::format("<td class=\"n\">{:.{}f}</td>", v, (*at)->digits) : "<td class=\"n\"></td>";
      }
      out += "</tr>\n";
    }
    out += "</tbody></table>\n";
  }
  return out;
}

}  // namespace insula
