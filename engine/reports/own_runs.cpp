// SPDX-License-Identifier: GPL-3.0-or-later
#include "engine/reports/own_runs.h"

#include <algorithm>
#include <fstream>
#include <nlohmann/json.hpp>
#include <tuple>

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

}  // namespace insula
