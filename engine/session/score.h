// SPDX-License-Identifier: GPL-3.0-or-later
// Scores a recorded session again, by the rules and metrics that were recorded with it or by those of another scene.
#pragma once
#include <optional>
#include <string>

#include "engine/reports/exercise_outcome.h"
#include "engine/session/rerun.h"

namespace insula {

struct ScoreResult {
  RerunResult rerun;
  std::optional<ExerciseOutcome> exercise;  ///< after the last step: that of the last pass
  std::int64_t metrics_compared = 0;        ///< recorded values that were computed again
  std::int64_t metrics_different = 0;       ///< those of them with other bits
  std::string first_different;              ///< "path_length (right) at 12.00 s"; empty: none
  /// Whether the metrics must have the same bits, and some have not. Other instructions give other bits.
  bool metrics_wrong() const { return rerun.same_instructions && metrics_different > 0; }
  /// Whether the run was the same, and the metrics too.
  bool good() const { return rerun.good() && !metrics_wrong(); }
};

/// Steps the engine from the recording. If the settings name no other rules, the recorded metrics are compared, each
/// second. Throws InputError if the session cannot be rerun.
ScoreResult score(SessionReader& session, const Registry& registry, const RerunSettings& settings);

}  // namespace insula
