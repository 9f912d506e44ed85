// SPDX-License-Identifier: GPL-3.0-or-later
// Outcome of a run, for programs and people.
#include "engine/reports/run_outcome.h"

#include <fmt/format.h>

#include <algorithm>

#include "core/mechanics/body.h"
#include "engine/reports/clinical_units.h"
#include "engine/reports/svg_plot.h"

namespace insula {
namespace {

using Json = nlohmann::ordered_json;
constexpr std::size_t max_requested = 1000;
/// Less than a drop in a minute is no bleeding.
constexpr double trickle_m3_s = 0.05 * m3_s_per_mL_min;

std::string table(const std::string& heading, const std::string& head, const std::string& rows) {
  return rows.empty() ? "" : "<h2>" + heading + "</h2>\n<table><thead><tr>" + head + "</tr></thead><tbody>\n" + rows + "</tbody></table>\n";
}

}  // namespace

void RunOutcome::observe(const StepReport& r) {
  bleeds_ = bleeds_ || !r.bleeding.empty();
  double lost = 0, rate = 0;
  for (const BleedingState& b : r.bleeding) {
    lost += b.lost;
    rate += b.rate;
    bleeding_.highest = std::max(bleeding_.highest, b.height);
    if (b.since >= 0 && (bleeding_.first < 0 || b.since < bleeding_.first)) bleeding_.first = b.since;
  }
  bleeding_.lost = lost;
  bleeding_.open = rate > trickle_m3_s;
  if (bleeding_.open) bleeding_.open_time += r.h;

  vessels_.resize(r.vessels.size());
  for (std::size_t i = 0; i < vessels_.size(); ++i) {
    const VesselState& v = r.vessels[i];
    if (vessels_[i].id != v.id) vessels_[i].id = v.id;
    vessels_[i].pressure = v.pressure;
    vessels_[i].flow = v.flow;
    vessels_[i].flow_at_rest = v.flow_at_rest;
    vessels_[i].lumen = v.lumen;
  }
  clips_.resize(r.clips.size());
  for (std::size_t i = 0; i < clips_.size(); ++i) {
    const ClipState& c = r.clips[i];
    if (c.clip && clips_[i].id != c.clip->id) clips_[i].id = c.clip->id;
    if (c.holder) clips_[i].holder = c.holder->id;
    else clips_[i].holder.clear();
    clips_[i].on_tray = c.on_tray;
    clips_[i].temporary = c.temporary;
    clips_[i].force = c.force;
    clips_[i].applications = c.applications;
  }
}

void RunOutcome::note(const std::vector<Event>& events) {
  for (const Event& e : events)
    if ((e.kind == "command" || e.kind == "refused" || (e.kind == "message" && e.id == "message")) && asked_.size() < max_requested)
      asked_.push_back({e.time, e.id, e.text, e.kind != "refused"});
}

void RunOutcome::add_to(Json& json) const {
  if (bleeds_)
    json["bleeding"] = {{"lost_mL", bleeding_.lost / m3_per_mL},
                        {"duration_s", bleeding_.open_time},
                        {"highest_mm", bleeding_.highest * 1000},
                        {"rupture_s", bleeding_.first < 0 ? Json() : Json(bleeding_.first)},
                        {"open", bleeding_.open}};
  json["vessels"] = Json::array();
  for (const Vessel& v : vessels_)
    json["vessels"].push_back({{"id", v.id},
                               {"pressure_mmHg", v.pressure / pascal_per_mmHg},
                               {"flow_mL_min", v.flow / m3_s_per_mL_min},
                               {"flow_percent", v.flow_at_rest != 0 ? Json(100 * v.flow / v.flow_at_rest) : Json()},
                               {"lumen_percent", 100 * v.lumen}});
  json["clips"] = Json::array();
  for (const Clip& c : clips_)
    json["clips"].push_back({{"id", c.id},
                             {"state", c.on_tray ? "tray" : c.holder.empty() ? "free" : "held"},
                             {"holder", c.holder.empty() ? Json() : Json(c.holder)},
                             {"applications", c.applications},
                             {"temporary", c.temporary},
                             {"force_N", c.force}});
  json["commands"] = Json::array();
  for (const Asked& a : asked_) {
    Json entry = {{"time_s", a.time}, {"command", a.verb}, {"done", a.done}};
    entry[a.done ? "argument" : "refused"] = a.text;
    json["commands"].push_back(entry);
  }
}

std::string RunOutcome::html() const {
  std::string out, rows;
  if (bleeding_.first >= 0)
    out += fmt::format("<h2>Bleeding</h2>\n<p class=\"bad\">{:.1f} mL lost in {:.1f} s of bleeding from {:.1f} s on; {}.</p>\n", bleeding_.lost / m3_per_mL,
                       bleeding_.open_time, bleeding_.first, bleeding_.open ? "it bleeds still" : "stopped");
  for (const Vessel& v : vessels_)
    rows += fmt::format("<tr><td>{}</td><td class=\"n\">{:.0f}</td><td class=\"n\">{:.0f}</td><td class=\"n\">{}</td><td class=\"n\">{:.0f}</td></tr>\n", escaped(v.id),
                        v.pressure / pascal_per_mmHg, v.flow / m3_s_per_mL_min, v.flow_at_rest != 0 ? fmt::format("{:.0f}", 100 * v.flow / v.flow_at_rest) : "", 100 * v.lumen);
  out += table("Vessels at the end",
               "<th>Vessel</th><th class=\"n\">Pressure (mmHg)</th><th class=\"n\">Flow (mL/min)</th><th class=\"n\">Flow (% of rest)</th><th class=\"n\">Lumen (% of rest)</th>", rows);
  rows.clear();
  for (const Clip& c : clips_) {
    if (c.on_tray && c.applications == 0) continue;
    rows += fmt::format("<tr><td>{}</td><td>{}</td><td class=\"n\">{}</td><td class=\"n\">{:.2f}</td></tr>\n", escaped(c.id + (c.temporary ? " (temporary)" : "")),
                        escaped(c.on_tray ? "on the tray" : c.holder.empty() ? "in the field" : "in " + c.holder), c.applications, c.force);
  }
  out += table("Clips used", "<th>Clip</th><th>At the end</th><th class=\"n\">Applied</th><th class=\"n\">Force (N)</th>", rows);
  rows.clear();
  for (const Asked& a : asked_)
    rows += fmt::format("<tr><td class=\"n\">{:.2f}</td><td>{}</td><td class=\"{}\">{}</td></tr>\n", a.time, escaped(a.verb), a.done ? "" : "bad",
                        escaped(a.done ? a.text : "refused: " + a.text));
  return out + table("Commands", "<th class=\"n\">Time (s)</th><th>Command</th><th>What</th>", rows);
}

Json complications_json(const ComplicationsOutcome& complications) {
  Json out = {{"seed", complications.seed}, {"drawn", Json::array()}};
  for (const DrawnComplication& d : complications.drawn)
    out["drawn"].push_back({{"id", d.id}, {"command", d.command}, {"probability", d.probability}, {"happens", d.happens},
                            {"time_s", d.happens ? Json(d.time) : Json()}, {"begun", d.begun}, {"refused", d.refused}});
  return out;
}

std::string complications_html(const ComplicationsOutcome& complications) {
  std::string rows;
  for (const DrawnComplication& d : complications.drawn)
    rows += fmt::format("<tr><td>{}</td><td>{}</td><td class=\"n\">{:.0f} %</td><td>{}</td></tr>\n", escaped(d.id), escaped(d.command), 100 * d.probability,
                        escaped(!d.happens            ? "not in this run"
                                : !d.begun            ? fmt::format("drawn for {:.1f} s, not reached", d.time)
                                : !d.refused.empty()  ? fmt::format("at {:.1f} s, refused: {}", d.time, d.refused)
                                                      : fmt::format("at {:.1f} s", d.time)));
  if (rows.empty()) return "";
  return table("Complications", "<th>Complication</th><th>What</th><th class=\"n\">Probability</th><th>Drawn</th>", rows) +
         fmt::format("<p class=\"quiet\">Drawn from seed {}.</p>\n", complications.seed);
}

}  // namespace insula
