// SPDX-License-Identifier: GPL-3.0-or-later
#include "engine/reports/metrics_report.h"

#include <fmt/format.h>

#include "engine/reports/csv.h"
#include "engine/reports/svg_plot.h"

namespace insula {

std::string shown_value(const MetricValue& m) {
  if (!m.known) return "";
  std::string number = fmt::format("{:.{}f}", m.value, m.digits);
  if (number.front() == '-' && number.find_first_not_of("-0.") == std::string::npos) number.erase(0, 1);
  return m.unit.empty() ? number : number + " " + m.unit;
}

nlohmann::ordered_json metric_json(const MetricValue& m) {
  return {{"id", m.id},
          {"hand", hand_name(m.hand)},
          {"unit", m.unit},
          {"value", m.known ? nlohmann::ordered_json(m.value) : nlohmann::ordered_json()},
          {"better", better_name(m.better)}};
}

nlohmann::ordered_json metrics_json(const std::vector<MetricValue>& metrics, bool with_source) {
  auto out = nlohmann::ordered_json::array();
  for (const MetricValue& m : metrics) {
    nlohmann::ordered_json& json = out.emplace_back(metric_json(m));
    json["digits"] = m.digits;
    json["text"] = m.text;
    if (with_source) json["source"] = m.source;
  }
  return out;
}

void add_bands(nlohmann::ordered_json& json, const std::vector<MetricValue>& metrics, const ReferenceBands& bands) {
  for (std::size_t i = 0; i < metrics.size(); ++i) {
    const ReferenceBand* band = bands.find(metrics[i]);
    if (!band) continue;
    const auto mark = band->pass_mark ? nlohmann::ordered_json(*band->pass_mark) : nlohmann::ordered_json();
    json[i]["band"] = {{"group", bands.group()}, {"median", band->median}, {"low", band->low},
                       {"high", band->high},     {"pass_mark", mark},      {"beyond", beyond_band(metrics[i], *band)}};
  }
}

std::string metrics_html(const std::vector<MetricValue>& metrics) {
  std::string rows;
  for (std::size_t i = 0; i < metrics.size(); ++i) {
    const MetricValue& m = metrics[i];
    if (m.hand == right_hand) continue;  // stands beside the left one
    const MetricValue* right = m.hand == left_hand && i + 1 < metrics.size() ? &metrics[i + 1] : nullptr;
    const auto says = [](const MetricValue* v) {
      return v && v->known && (v->value != 0 || v->better != Better::none);
    };
    if (!says(&m) && !says(right)) continue;
    const std::string values = m.hand == both_hands
                                   ? fmt::format("<td class=\"n\" colspan=\"2\">{}</td>", escaped(shown_value(m)))
                                   : fmt::format("<td class=\"n\">{}</td><td class=\"n\">{}</td>",
                                                 escaped(shown_value(m)), right ? escaped(shown_value(*right)) : "");
    rows += fmt::format("<tr><td>{}</td>{}<td>{}</td></tr>\n", escaped(m.text), values,
                        m.better == Better::low    ? "less"
                        : m.better == Better::high ? "more"
                                                   : "");
  }
  if (rows.empty()) return {};
  return "<h2>How the hands worked</h2>\n<table><thead><tr><th>Metric</th><th class=\"n\">Left</th><th "
         "class=\"n\">Right</th><th>Better is</th></tr></thead><tbody>\n" +
         rows + "</tbody></table>\n";
}

std::string metrics_csv(const std::vector<MetricValue>& metrics) {
  std::string out = "id,hand,value,unit,better,text\n";
  for (const MetricValue& m : metrics)
    out += fmt::format("{},{},{},{},{},{}\n", csv_text(m.id), hand_name(m.hand),
                       m.known ? fmt::format("{}", m.value) : "", m.unit, better_name(m.better), csv_text(m.text));
  return out;
}

}  // namespace insula
