// SPDX-License-Identifier: GPL-3.0-or-later
#include "engine/reports/attempts.h"

#include <limits>

#include "engine/live/project_folder.h"
#include "training/curriculum/curriculum.h"

namespace insula {

Attempt attempt_of(const training::Run& run) {
  Attempt out;
  out.scene = scene_key(scene_file(run.scene));
  out.began_ms = run.began_ms;
  out.mode = run.mode;
  out.done = run.done();
  for (const training::RunFault& f : run.fault_counts) out.faults[f.id] = f.count;
  for (const training::RunMetric& m : run.metrics) out.metrics[{m.id, m.hand}] = m.value;
  if (run.seed && *run.seed >= 0 && *run.seed <= std::numeric_limits<int>::max()) out.seed = int(*run.seed);
  out.guided = run.guided;
  return out;
}

std::vector<Attempt> attempts_of(const training::Store& store, const std::string& person) {
  std::vector<Attempt> out;
  for (const training::Run& run : store.full_runs(person)) out.push_back(attempt_of(run));
  return out;
}

}  // namespace insula
