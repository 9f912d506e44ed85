// SPDX-License-Identifier: GPL-3.0-or-later
#include "engine/reports/hints_report.h"

#include <fmt/format.h>

#include <cmath>

#include "core/base/spoken.h"
#include "engine/reports/svg_plot.h"

namespace insula {

using Json = nlohmann::ordered_json;

namespace {

/// "brain_force.left.force" is read as "brain force, left, force".
std::string watched_words(std::string id) {
  for (std::size_t at = 0; (at = id.find('.', at)) != std::string::npos; at += 2) id.replace(at, 1, ", ");
  return spoken(std::move(id));
}

}  // namespace

Json hint_json(const HintCause& cause) {
  return {{"id", cause.id},
          {"text", cause.text},
          {"hand", cause.hand < 0 ? std::string() : std::string(hand_name(cause.hand))},
          {"watched", cause.watched},
          {"value", cause.value},
          {"limit", cause.limit},
          {"share", std::round(1000 * cause.share) / 1000},
          {"holds", cause.holds}};
}

Json cues_json(const std::vector<Cue>& cues) {
  Json out = Json::array();
  for (const Cue& cue : cues) {
    Json one = hint_json(cue.cause);
    one["time_s"] = std::round(1000 * cue.time) / 1000;
    out.push_back(one);
  }
  return out;
}

std::string cues_html(const std::vector<Cue>& cues, bool seen) {
  if (cues.empty()) return {};
  std::string out = "<h2>Hints of the tutor</h2>\n";
  if (!seen) out += "<p class=\"quiet\">A test shows no hints. Practice would have shown these.</p>\n";
  out +=
      "<table><thead><tr><th class=\"n\">Time (s)</th><th>Hint</th><th>Why: what came near its limit</th>"
      "<th class=\"n\">Value</th><th class=\"n\">Limit</th><th class=\"n\">Share</th></tr></thead><tbody>\n";
  for (const Cue& cue : cues) {
    const HintCause& c = cue.cause;
    out += fmt::format(
        "<tr><td class=\"n\">{:.2f}</td><td>{}</td><td>{}</td><td class=\"n\">{}</td>"
        "<td class=\"n\">{}</td><td class=\"n\">{:.0f} %</td></tr>\n",
        cue.time, escaped(c.text), escaped(watched_words(c.watched)), escaped(c.value), escaped(c.limit),
        100 * c.share);
  }
  return out + "</tbody></table>\n";
}

}  // namespace insula
