// SPDX-License-Identifier: GPL-3.0-or-later
// One attempt of a person at an exercise, as a report or a recorded session has it.
#pragma once
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <utility>

namespace insula {

struct Attempt {
  std::string scene;                  ///< as scene_key() of training/curriculum/curriculum.h names it
  std::int64_t began_ms = 0;          ///< UTC, since 1970-01-01
  std::string mode;                   ///< "test", "practice" or "demonstration"; a demonstration counts for nothing
  bool done = false;                  ///< all required goals were reached
  std::map<std::string, int> faults;  ///< number of each fault by id; a missing one is 0
  /// By id and hand ("left", "right", "both"), in the unit in which the exercise shows the metric. An unknown value is
  /// missing, or not a number.
  std::map<std::pair<std::string, std::string>, double> metrics;
  /// Seed of the complications. An attempt whose seed is not known counts for no task that states seeds.
  std::optional<int> seed = {};
  /// Whether practice may have shown targets of a guide. A test never does.
  bool guided = true;
  std::string run = {};  ///< name of the run that it comes from, for whoever shows it
};

}  // namespace insula
