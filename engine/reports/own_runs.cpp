// SPDX-License-Identifier: GPL-3.0-or-later
#include "engine/reports/own_runs.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <nlohmann/json.hpp>
#include <tuple>

#include "engine/reports/svg_plot.h"

namespace insula {
namespace fs = std::filesystem;
namespace {

constexpr std::size_t most_reports = 200, most_rows = 8;

std::optional<OwnRun> read(const fs::path& report, const std::string& title, const std::string& person) {
  std::ifstream in(report);
  const auto json = nlohmann::json::parse(in, nullptr, false);
  try {
    if (json.at("title") != title || json.value("mode", "") == "demonstration") return std::nullopt;
    const auto fields = json.value("fields", nlohmann::json::object());
    if (fields.value("person", "") != person || !json.at("exercise").is_object()) return std::nullopt;
    const auto& exercise = json.at("exercise");
    OwnRun run;
    run.began = json.value("began", "");
    run.done = exercise.at("state") == "done";
    run.seconds = json.at("sim_seconds");
    for (const auto& f : exercise.at("faults")) run.faults += f.at("count").get<int>();
    for (const auto& m : json.at("metrics"))
      if (m.at("value").is_number()) run.metrics[{m.at("id"), m.at("hand")}] = m.at("value");
    return run;
  } catch (const nlohmann::json::exception&) {
    return std::nullopt;  // not a report of this version
  }
}

std::string number(double value, int digits, const std::string& unit) {
  return fmt::format("{:.{}f}{}{}", value, digits, unit.empty() ? "" : " ", unit);
}

std::string cells(const std::string& now, const std::string& last, const std::string& best) {
  std::string out;
  for (const std::string& text : {now, last, best}) out += fmt::format("<td class=\"n\">{}</td>", escaped(text));
  return out;
}

/// How much a metric has changed since the last run, as a share of the larger value.
double change(const MetricValue& metric, double before) {
  return std::abs(metric.value - before) / std::max({std::abs(metric.value), std::abs(before), 1e-12});
}

}  // namespace

OwnRuns own_runs(const fs::path& folder, const std::string& title, const std::string& person, const fs::path& except) {
  std::vector<fs::path> reports;
  std::error_code error;
  for (fs::directory_iterator it(folder, error), end; !error && it != end; it.increment(error))
    if (std::error_code ignored; it->path() != except && fs::is_regular_file(it->path() / "report.json", ignored))
      reports.push_back(it->path());
  // Their names begin with date and time.
  std::sort(reports.rbegin(), reports.rend());
  if (reports.size() > most_reports) reports.resize(most_reports);
  OwnRuns out;
  const auto rank = [](const OwnRun& r) { return std::tuple(!r.done, r.faults, r.seconds); };
  for (const fs::path& report : reports) {
    const std::optional<OwnRun> run = read(report / "report.json", title, person);
    if (!run) continue;
    ++out.count;
    if (!out.last) out.last = run;
    if (!out.best || rank(*run) < rank(*out.best)) out.best = run;
  }
  return out;
}

std::string own_runs_html(const OwnRuns& runs, const OwnRun& now, const std::vector<MetricValue>& metrics) {
  if (!runs.last || !runs.best) return {};
  const OwnRun &last = *runs.last, &best = *runs.best;
  std::string out = fmt::format(
      "<h2>Beside your earlier runs</h2>\n<p class=\"quiet\">{} earlier run{} of this exercise. The best one reached "
      "all goals with the fewest faults, in the shortest time.</p>\n<table><thead><tr><th></th><th class=\"n\">This "
      "run</th><th class=\"n\">Last</th><th class=\"n\">Best</th></tr></thead><tbody>\n",
      runs.count, runs.count == 1 ? "" : "s");
  const auto yes = [](const OwnRun& r) { return r.done ? "✓ yes" : "✗ no"; };
  out += "<tr><td>All goals reached</td>" + cells(yes(now), yes(last), yes(best)) + "</tr>\n";
  out += "<tr><td>Time</td>" +
         cells(number(now.seconds, 1, "s"), number(last.seconds, 1, "s"), number(best.seconds, 1, "s")) + "</tr>\n";
  out += "<tr><td>Faults</td>" +
         cells(number(now.faults, 0, ""), number(last.faults, 0, ""), number(best.faults, 0, "")) + "</tr>\n";
  // What has changed most since the last run, of what has a better side.
  std::vector<const MetricValue*> changed;
  const auto before = [](const OwnRun& run, const MetricValue& m) -> std::optional<double> {
    const auto found = run.metrics.find({m.id, std::string(hand_name(m.hand))});
    return found == run.metrics.end() ? std::nullopt : std::optional(found->second);
  };
  for (const MetricValue& m : metrics)
    if (m.known && m.better != Better::none && before(last, m) && before(best, m)) changed.push_back(&m);
  std::stable_sort(changed.begin(), changed.end(), [&](const MetricValue* a, const MetricValue* b) {
    return change(*a, *before(last, *a)) > change(*b, *before(last, *b));
  });
  if (changed.size() > most_rows) changed.resize(most_rows);
  for (const MetricValue* m : changed) {
    const double was = *before(last, *m);
    const bool better = m->better == Better::low ? m->value < was : m->value > was;
    const std::string name = m->hand == both_hands ? m->text : fmt::format("{} ({} hand)", m->text, hand_name(m->hand));
    const std::string sign = m->value == was ? "" : better ? " ✓ better" : " ✗ worse";
    out += fmt::format("<tr><td>{}<span class=\"{}\">{}</span></td>", escaped(name), better ? "good" : "bad", sign) +
           cells(number(m->value, m->digits, m->unit), number(was, m->digits, m->unit),
                 number(*before(best, *m), m->digits, m->unit)) +
           "</tr>\n";
  }
  return out + "</tbody></table>\n";
}

}  // namespace insula
