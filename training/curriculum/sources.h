// SPDX-License-Identifier: GPL-3.0-or-later
// What a curriculum needs to know of scenes and of bands. Whoever loads a curriculum provides it, so this folder needs
// no plugin and no simulation (engine/authoring/curriculum_sources.h reads the files).
#pragma once
#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "core/base/diagnostic.h"
#include "core/params/quantity.h"
#include "core/sim/metric.h"

namespace insula {

struct FaultFact {
  std::string id;
  std::string text;  ///< what it is, for the trainee
};

/// One metric of an exercise.
struct MetricFact {
  std::string id;
  std::string text;  ///< what it is, for the trainee
  Of of = Of::both_hands;
  Better better = Better::none;
  std::string quantity;         ///< its name in messages
  std::span<const Unit> units;  ///< in which a limit may be written; none: a plain number
  std::string unit;             ///< in which the exercise shows it; may be empty
  double scale = 1;             ///< shown number = SI value * scale
};

struct SceneFacts {
  Diagnostics diagnostics;  ///< of the scene; the rest is known only without errors
  std::string title;        ///< of the scene
  bool has_exercise = false;
  bool has_complications = false;   ///< that a seed draws
  std::vector<std::string> goals;   ///< ids
  std::vector<FaultFact> faults;    ///< in the order of the exercise
  std::vector<MetricFact> metrics;  ///< in the order of the exercise
};

/// Figures of a group for one metric, in the metric's unit.
struct BandFact {
  double low = 0, median = 0, high = 0;  ///< low, high: quartiles
  std::optional<double> pass_mark;
};

class CurriculumSources {
 public:
  virtual ~CurriculumSources() = default;
  /// Where the shipped curricula are. A curriculum elsewhere, as in the user's data, may name files as if it lay here.
  /// Empty: there is no such folder.
  virtual std::filesystem::path shipped_folder() const { return {}; }
  /// The same file gives the same facts, which stay where they are.
  virtual const SceneFacts& scene(const std::filesystem::path& file) = 0;
  /// The bands of an exercise of that scene. Returns nothing, with the reason in `error`, if the file has no such group
  /// or metric, or is of another exercise. hand: "left", "right" or "both".
  virtual std::optional<BandFact> band(const std::filesystem::path& bands, const std::string& group,
                                       const SceneFacts& scene, const MetricFact& metric, const std::string& hand,
                                       std::string& error) = 0;
};

}  // namespace insula
