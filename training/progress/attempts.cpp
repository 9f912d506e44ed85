// SPDX-License-Identifier: GPL-3.0-or-later
#include "training/progress/attempts.h"

#include <limits>

#include "training/curriculum/curriculum.h"

namespace insula::training {

Attempt attempt_of(const Run& run, const std::filesystem::path& project) {
  Attempt out;
  out.scene = scene_key(project / run.scene);
  out.began_ms = run.began_ms;
  out.mode = run.mode;
  out.done = run.done();
  for (const RunFault& f : run.fault_counts) out.faults[f.id] = f.count;
  for (const RunMetric& m : run.metrics) out.metrics[{m.id, m.hand}] = m.value;
  if (run.seed && *run.seed >= 0 && *run.seed <= std::numeric_limits<int>::max()) out.seed = int(*run.seed);
  out.guided = run.guided;
  out.run = run.uuid;
  return out;
}

std::vector<Attempt> attempts_of(const Store& store, const std::string& person, const std::filesystem::path& project) {
  std::vector<Attempt> out;
  for (const Run& run : store.full_runs(person)) out.push_back(attempt_of(run, project));
  return out;
}

}  // namespace insula::training
