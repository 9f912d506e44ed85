// SPDX-License-Identifier: GPL-3.0-or-later
// The outcome of an exercise in reports for programs: goals, faults, clocks, measures and metrics.
#pragma once
#include <algorithm>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "core/sim/exercise.h"
#include "core/sim/tutor.h"

namespace insula {

/// Copy of an exercise at the time of the report.
struct ExerciseOutcome {
  explicit ExerciseOutcome(const Exercise& exercise)
      : id(exercise.id),
        title(exercise.title()),
        text(exercise.text()),
        log(exercise.log()),
        metrics(exercise.metrics()),
        has_guide(std::ranges::any_of(exercise.motions(), [](const MotionEntry* m) { return m->guide(); })) {
    if (const GivesCues* tutor = tutor_of(exercise)) cues = tutor->cues();
  }
  std::string id, title, text;
  ExerciseLog log;
  std::vector<MetricValue> metrics;
  bool has_guide;         ///< practice shows targets
  std::vector<Cue> cues;  ///< of the tutor, in order
};

/// "running", "done" or "failed".
const char* state_name(ExerciseState state);

/// {id, title, state, goals, faults, timers, measures}; without an exercise only the lists, empty. The metrics stand
/// beside it (metrics_report.h).
nlohmann::ordered_json exercise_json(const std::optional<ExerciseOutcome>& exercise);

}  // namespace insula
