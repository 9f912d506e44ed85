// SPDX-License-Identifier: GPL-3.0-or-later
// Which attempts count for which task, and which satisfy a gate.
#include <algorithm>
#include <cmath>

#include "training/curriculum/evaluate.h"

namespace insula {
namespace {

int faults_of(const Attempt& attempt, const Gate& gate) {
  std::int64_t sum = 0;
  for (const auto& [id, count] : attempt.faults)
    if (gate.faults.empty() || std::find(gate.faults.begin(), gate.faults.end(), id) != gate.faults.end())
      sum += std::max(count, 0);
  return int(std::min<std::int64_t>(sum, 1'000'000'000));
}

bool metric_fits(const Attempt& attempt, const Gate& gate) {
  const auto found = attempt.metrics.find({gate.metric, gate.hand});
  if (found == attempt.metrics.end() || std::isnan(found->second)) return false;
  if (gate.at_least && !(found->second >= *gate.at_least)) return false;
  return !gate.at_most || found->second <= *gate.at_most;
}

}  // namespace

bool satisfies(const Attempt& attempt, const Gate& gate) {
  switch (gate.kind) {
    case Gate::Kind::goals: return attempt.done;
    case Gate::Kind::faults: return faults_of(attempt, gate) <= gate.most_faults;
    case Gate::Kind::metric: return metric_fits(attempt, gate);
  }
  return false;
}

bool counts_for(const Attempt& attempt, const Task& task) {
  if (attempt.scene != task.scene) return false;
  if (attempt.mode == "practice") {
    if (task.mode == TaskMode::test || (attempt.guided && !task.guide)) return false;
  } else if (attempt.mode != "test") {
    return false;
  }
  if (task.seeds.empty()) return true;
  return attempt.seed && std::find(task.seeds.begin(), task.seeds.end(), *attempt.seed) != task.seeds.end();
}

}  // namespace insula
