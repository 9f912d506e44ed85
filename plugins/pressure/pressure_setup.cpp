// SPDX-License-Identifier: GPL-3.0-or-later
// Chambers from the scene, and commands, of the blood pressure.
#include "plugins/pressure/pressure.h"

#include <algorithm>
#include <cmath>

#include "core/base/text.h"
#include "core/params/number.h"

namespace insula {
namespace {

constexpr double mmHg = 133.322387415;

std::vector<std::string> words(std::string_view text) {
  std::vector<std::string> out;
  for (std::string_view w : split_blanks(text)) out.emplace_back(w);
  return out;
}

}  // namespace

bool BloodPressure::read_groups(PrepareContext& context, std::vector<std::vector<std::string>>& groups) const {
  const WallModel& model = on->model();
  if (regions().find_first_not_of(" \t\r\n") == std::string::npos) {
    // A region with a centreline is a stretch of vessel, or the sac. Other regions belong to their neighbours.
    for (const std::string& r : model.regions)
      if (std::any_of(model.centrelines.begin(), model.centrelines.end(), [&](const auto& c) { return c.region == r; }))
        groups.push_back({r});
    if (groups.empty()) groups.push_back({model.regions.front()});
  } else {
    std::string_view rest = regions();
    while (true) {
      const std::size_t end = rest.find(';');
      if (auto w = words(rest.substr(0, end)); !w.empty()) groups.push_back(std::move(w));
      if (end == std::string_view::npos) break;
      rest.remove_prefix(end + 1);
    }
    if (groups.empty()) {
      error(context, regions, "names no region");
      return false;
    }
  }
  bool good = true;
  std::vector<std::string> seen;
  for (const auto& g : groups)
    for (const std::string& r : g) {
      if (on->region(r) < 0) {
        const std::string near = nearest_name(r, model.regions);
        error(context, regions, in_quotes(on->id) + " has no region " + in_quotes(r) + did_you_mean(near));
        good = false;
      } else if (std::find(seen.begin(), seen.end(), r) != seen.end()) {
        error(context, regions, "region " + in_quotes(r) + " is named twice");
        good = false;
      }
      seen.push_back(r);
    }
  if (good && int(groups.size()) > max_chambers) {
    error(context, regions,
          std::to_string(groups.size()) + " chambers are too many; group the regions into at most " +
              std::to_string(max_chambers));
    good = false;
  }
  return good;
}

bool BloodPressure::make_chambers(PrepareContext& context) {
  const auto& triangles = on->rest().triangles;
  std::vector<std::pair<int, int>> edges;
  for (const auto& t : triangles)
    for (std::size_t k = 0; k < 3; ++k) edges.emplace_back(t[k], t[(k + 1) % 3]);
  std::sort(edges.begin(), edges.end());
  for (const auto& [a, b] : edges)
    if (!std::binary_search(edges.begin(), edges.end(), std::pair(b, a))) {
      error(context, on,
            in_quotes(on->id) + " is not closed (edge between vertices " + std::to_string(a) + " and " +
                std::to_string(b) + "), so it holds no pressure");
      return false;
    }
  std::vector<std::vector<std::string>> groups;
  if (!read_groups(context, groups)) return false;
  chambers_.build(*on, groups);
  const std::size_t n = std::size_t(chambers_.count());
  VecX rest(3 * on->nodes());
  for (int i = 0; i < on->nodes(); ++i) rest.segment<3>(3 * i) = on->rest_nodes()[std::size_t(i)];
  double volume = 0, area = 0;
  for (int c = 0; c < int(n); ++c) {
    rest_volume_.push_back(chambers_.volume(c, rest));
    volume += rest_volume_.back();
    area += chambers_.area(c);
    bool yields = false;
    for (int v : chambers_.nodes(c)) yields = yields || !on->fixed()[std::size_t(v)];
    yields_.push_back(yields);
  }
  if (!(volume > 0)) {
    error(context, on,
          in_quotes(on->id) + " is turned inside out: its triangles must be counter-clockwise from outside");
    return false;
  }
  area_ = area / double(n);
  rows_.resize(n);
  mix_.assign(n * n, 0.0);
  gradient_.resize(n);
  for (int c = 0; c < int(n); ++c) gradient_[std::size_t(c)].reserve(chambers_.nodes(c).size());
  row_nodes_.reserve(std::size_t(on->nodes()) * (n + 1));
  row_gradient_.assign(std::size_t(on->nodes()), Vec3::Zero());
  volume_.assign(n, 0.0);
  flow_.assign(n, 0.0);
  yielding_.assign(n * n, 0.0);
  at_node_.assign(n, 0.0);
  mesh_.clear(int(n));
  excess_.assign(n, 0.0);
  chambers_.bind(on->system(), on->free_of_node());
  on->filling_gradient = this;
  prestress_wall(&context);
  reset();
  return true;
}

/// A shell without a wall that can be prestressed, on springs alone, does not count the pressure of imaging. If a
/// network feeds the chambers, each has a reference of its own, and a second call adds only the difference.
void BloodPressure::prestress_wall(PrepareContext* context) {
  if (!prestress()) return;
  constexpr double good = 1e-8;
  VecX load = VecX::Zero(3 * on->nodes()), q = load;
  for (int i = 0; i < on->nodes(); ++i) q.segment<3>(3 * i) = on->rest_nodes()[std::size_t(i)];
  for (int c = 0; c < chambers_.count(); ++c) {
    chambers_.gradient(c, q, gradient_[std::size_t(c)]);
    for (std::size_t i = 0; i < gradient_[std::size_t(c)].size(); ++i)
      load.segment<3>(3 * chambers_.nodes(c)[i]) += reference(c) * gradient_[std::size_t(c)][i];
  }
  const double left = on->prestress(load);
  prestressed_ = prestressed_ || left < good;  // the imbalance of a second call is part of a small difference
  if (!prestressed_ && left < 1 && context)
    error(*context, prestress,
          "no tension of " + in_quotes(on->id) +
              " bears the pressure of its image; with prestress=\"false\" only the excess over that pressure loads it");
}

std::vector<CommandInfo> BloodPressure::commands() const {
  const auto in = [](double si, double unit) { return std::round(si / unit * 1e6) / 1e6; };
  return {
      {"set_systolic", "systolic pressure", "pressure_mmHg", in(*systolic.min(), mmHg), in(*systolic.max(), mmHg)},
      {"set_diastolic", "diastolic pressure", "pressure_mmHg", in(*diastolic.min(), mmHg), in(*diastolic.max(), mmHg)},
      {"set_heart_rate", "heart rate", "beats_per_min", in(*heart_rate.min(), 1.0 / 60),
       in(*heart_rate.max(), 1.0 / 60)}};
}

std::string BloodPressure::run_command(std::string_view name, std::string_view argument) {
  for (const CommandInfo& c : commands()) {
    if (c.name != name) continue;
    std::string why;
    const auto value = read_number(trim(argument), why);
    if (!value) return std::string(name) + " needs a number: " + why;
    if (*value < c.min || *value > c.max)
      return std::string(name) + ": " + shown(argument) + " is outside the allowed range " +
             std::to_string(int(c.min)) + " to " + std::to_string(int(c.max));
    if (name == "set_heart_rate") rate_wanted_ = *value / 60;
    else if (name == "set_systolic") {
      if (*value * mmHg < diastolic_wanted_) return "systolic pressure cannot be below diastolic";
      systolic_wanted_ = *value * mmHg;
    } else {
      if (*value * mmHg > systolic_wanted_) return "diastolic pressure cannot be above systolic";
      diastolic_wanted_ = *value * mmHg;
    }
    return {};
  }
  return "unknown command " + in_quotes(name);
}

}  // namespace insula
