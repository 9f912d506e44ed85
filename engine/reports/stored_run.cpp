// SPDX-License-Identifier: GPL-3.0-or-later
#include "engine/reports/stored_run.h"

#include "engine/live/project_folder.h"
#include "engine/live/session_mode.h"
#include "training/store/store.h"

namespace insula {

training::Run stored_run(const RunRecorder& recorder, const RunSummary& summary, const std::string& report) {
  const ExerciseOutcome& exercise = summary.exercise.value();
  training::Run run;
  run.uuid = training::new_uuid();
  run.person = summary.person();
  run.scene = scene_name(summary.scene);
  run.title = exercise.title;
  run.mode = summary.mode;
  run.began_ms = summary.began_ms;
  run.duration_s = recorder.samples().empty() ? 0 : double(recorder.samples().back().time_s);
  run.state = state_name(exercise.log.state());
  for (const GoalState& g : exercise.log.goals()) {
    if (!g.required) continue;
    ++run.goals;
    run.goals_done += g.done;
  }
  for (const FaultState& f : exercise.log.faults()) {
    run.faults += f.count;
    if (f.count > 0) run.fault_counts.push_back({f.id, f.text, f.count});
  }
  run.step_rate_hz = summary.step_rate_hz;
  if (summary.complications) run.seed = std::int64_t(summary.complications->seed);
  run.guided = exercise.has_guide && summary.mode == name_of(SessionMode::practice);
  run.report = report;
  run.recording = summary.recording;
  run.version = INSULA_VERSION;
  for (const MetricValue& m : exercise.metrics)
    if (m.known)
      run.metrics.push_back({m.id, std::string(hand_name(m.hand)), m.value, m.text, m.unit,
                             std::string(better_name(m.better)), m.digits});
  return run;
}

}  // namespace insula
