// SPDX-License-Identifier: GPL-3.0-or-later
#include "engine/reports/force_record.h"

#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>

#include "core/mechanics/body.h"
#include "engine/reports/svg_plot.h"

namespace insula {

void ForceRecord::observe(const StepReport& report) {
  if (figures_.empty())
    for (const StructureForce& s : report.structures) figures_.push_back({s.body->id});
  for (std::size_t i = 0; i < figures_.size() && i < report.structures.size(); ++i) {
    const double force = report.structures[i].largest();
    if (!(force > 0)) continue;
    Figures& f = figures_[i];
    f.max_N = std::max(f.max_N, force);
    f.touched_s += report.h;
    f.impulse_Ns += force * report.h;
  }
}

nlohmann::ordered_json ForceRecord::json() const {
  nlohmann::ordered_json out = nlohmann::ordered_json::object();
  for (const Figures& f : figures_)
    out[f.id] = {{"max_N", f.max_N}, {"mean_N", f.mean_N()}, {"impulse_Ns", f.impulse_Ns}};
  return out;
}

std::string ForceRecord::html() const {
  std::string rows;
  for (const Figures& f : figures_)
    if (f.touched_s > 0)
      rows += fmt::format(
          "<tr><td>{}</td><td class=\"n\">{:.3f}</td><td class=\"n\">{:.3f}</td><td class=\"n\">{:.2f}</td></tr>\n",
          escaped(f.id), f.max_N, f.mean_N(), f.impulse_Ns);
  if (rows.empty()) return "";
  return "<h2>Forces of the hands on structures</h2>\n<table><thead><tr><th>Structure</th><th class=\"n\">Largest "
         "(N)</th><th class=\"n\">Mean while touched (N)</th><th class=\"n\">Impulse (N s)</th></tr></thead><tbody>\n" +
         rows + "</tbody></table>\n";
}

}  // namespace insula
