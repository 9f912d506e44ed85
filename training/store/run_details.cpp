// SPDX-License-Identifier: GPL-3.0-or-later
#include "training/store/run_details.h"

#include <fmt/format.h>

#include <cmath>
#include <unordered_map>

namespace insula::training {

void insert_details(const Database& database, const Run& run, std::int64_t id) {
  Statement declares = database.prepare("INSERT OR REPLACE INTO metrics VALUES (?1, ?2, ?3, ?4, ?5, ?6)");
  Statement measures = database.prepare("INSERT OR REPLACE INTO run_metrics VALUES (?1, ?2, ?3, ?4)");
  for (const RunMetric& m : run.metrics) {
    if (!std::isfinite(m.value)) continue;
    declares.bind(run.scene, m.id, m.text, m.unit, m.better, m.digits).run();
    measures.bind(id, m.id, m.hand, m.value).run();
  }
  Statement counts = database.prepare("INSERT OR REPLACE INTO run_faults VALUES (?1, ?2, ?3, ?4)");
  for (const RunFault& f : run.fault_counts) counts.bind(id, f.id, f.text, f.count).run();
}

void read_details(const Database& database, std::vector<Run>& runs, std::string_view which,
                  const std::function<void(Statement&)>& bind) {
  std::unordered_map<std::int64_t, Run*> by_id;
  for (Run& run : runs) by_id.emplace(run.id, &run);
  const auto run_of = [&](const Statement& s) {
    const auto found = by_id.find(s.integer(0));
    return found == by_id.end() ? nullptr : found->second;
  };
  Statement m = database.prepare(fmt::format(
      "SELECT v.run, v.metric, v.hand, v.value, m.text, m.unit, m.better, m.digits FROM runs JOIN run_metrics v ON "
      "v.run = runs.id JOIN metrics m ON m.scene = runs.scene AND m.metric = v.metric WHERE {} "
      "ORDER BY v.run, v.metric, v.hand",
      which));
  bind(m);
  while (m.step())
    if (Run* run = run_of(m))
      run->metrics.push_back({m.text(1), m.text(2), m.real(3), m.text(4), m.text(5), m.text(6), int(m.integer(7))});
  Statement f = database.prepare(
      fmt::format("SELECT f.run, f.fault, f.text, f.count FROM runs JOIN run_faults f ON f.run = runs.id WHERE {} "
                  "ORDER BY f.run, f.fault",
                  which));
  bind(f);
  while (f.step())
    if (Run* run = run_of(f)) run->fault_counts.push_back({f.text(1), f.text(2), int(f.integer(3))});
}

}  // namespace insula::training
