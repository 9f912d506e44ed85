// SPDX-License-Identifier: GPL-3.0-or-later
// Commands and complications of a run, in both reports.
#include "engine/reports/run_outcome.h"

#include <fmt/format.h>

#include <algorithm>

#include "engine/reports/svg_plot.h"

namespace insula {
namespace {

using Json = nlohmann::ordered_json;
constexpr std::size_t max_requested = 1000;

std::string table(const std::string& heading, const std::string& head, const std::string& rows) {
  return rows.empty() ? ""
                      : "<h2>" + heading + "</h2>\n<table><thead><tr>" + head + "</tr></thead><tbody>\n" + rows +
                            "</tbody></table>\n";
}

}  // namespace

void RunOutcome::note(const std::vector<Event>& events) {
  for (const Event& e : events)
    if ((e.kind == "command" || e.kind == "refused" || (e.kind == "message" && e.id == "message")) &&
        asked_.size() < max_requested)
      asked_.push_back({e.time, e.id, e.text, e.kind != "refused"});
}

void RunOutcome::add_to(Json& json) const {
  json["commands"] = Json::array();
  for (const Asked& a : asked_) {
    Json entry = {{"time_s", a.time}, {"command", a.verb}, {"done", a.done}};
    entry[a.done ? "argument" : "refused"] = a.text;
    json["commands"].push_back(entry);
  }
}

std::string RunOutcome::html() const {
  std::string rows;
  for (const Asked& a : asked_)
    rows += fmt::format("<tr><td class=\"n\">{:.2f}</td><td>{}</td><td class=\"{}\">{}</td></tr>\n", a.time,
                        escaped(a.verb), a.done ? "" : "bad", escaped(a.done ? a.text : "refused: " + a.text));
  return table("Commands", "<th class=\"n\">Time (s)</th><th>Command</th><th>What</th>", rows);
}

Json complications_json(const ComplicationsOutcome& complications) {
  Json out = {{"seed", complications.seed}, {"drawn", Json::array()}};
  for (const DrawnComplication& d : complications.drawn)
    out["drawn"].push_back({{"id", d.id},
                            {"command", d.command},
                            {"probability", d.probability},
                            {"happens", d.happens},
                            {"time_s", d.happens ? Json(d.time) : Json()},
                            {"begun", d.begun},
                            {"refused", d.refused}});
  return out;
}

std::string complications_html(const ComplicationsOutcome& complications) {
  std::string rows;
  for (const DrawnComplication& d : complications.drawn)
    rows += fmt::format("<tr><td>{}</td><td>{}</td><td class=\"n\">{:.0f} %</td><td>{}</td></tr>\n", escaped(d.id),
                        escaped(d.command), 100 * d.probability,
                        escaped(!d.happens           ? "not in this run"
                                : !d.begun           ? fmt::format("drawn for {:.1f} s, not reached", d.time)
                                : !d.refused.empty() ? fmt::format("at {:.1f} s, refused: {}", d.time, d.refused)
                                                     : fmt::format("at {:.1f} s", d.time)));
  if (rows.empty()) return "";
  return table("Complications", "<th>Complication</th><th>What</th><th class=\"n\">Probability</th><th>Drawn</th>",
               rows) +
         fmt::format("<p class=\"quiet\">Drawn from seed {}.</p>\n", complications.seed);
}

}  // namespace insula
