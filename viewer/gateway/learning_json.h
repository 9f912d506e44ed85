// SPDX-License-Identifier: GPL-3.0-or-later
// A learning curve with the level that it is measured against, for pages.
#pragma once
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "training/curriculum/curriculum.h"
#include "training/store/store.h"

namespace insula::gateway {

/// Values of a metric that count as learnt, in the metric's unit.
struct Level {
  std::optional<double> at_least, at_most;
  int in_a_row = 1;    ///< attempts one after the other that reach it
  std::string source;  ///< "curriculum" or "specialists"
};

Level level_of(const Gate& gate);
/// The median of what specialists on this machine have done in this exercise, in attempts that reached all goals. None
/// with fewer than `fewest_expert_attempts` of them, or if the metric has no better side.
std::optional<Level> level_of_specialists(const training::Store& store, const std::string& scene,
                                          const training::RunMetric& metric);
inline constexpr std::size_t fewest_expert_attempts = 5;

/// {metric, hand, text, unit, better, digits, points}. With a level also {level: {at_least, at_most, in_a_row, source},
/// attempts_to_level, cusum: {sum, h0, h1, accepted, alarmed}} of training/curriculum/learning.h. An attempt fails if a
/// goal is missing or its value is beyond the level.
nlohmann::ordered_json curve_json(const training::LearningCurve& curve, const std::optional<Level>& level);

}  // namespace insula::gateway
