// SPDX-License-Identifier: GPL-3.0-or-later
// Earlier runs of the same person in the same exercise, from the reports beside this one.
#pragma once
#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace insula {

struct OwnRun {
  std::string began;
  bool done = false;                                              ///< all goals were reached
  double seconds = 0;                                             ///< of the exercise
  int faults = 0;                                                 ///< all together
  std::map<std::pair<std::string, std::string>, double> metrics;  ///< by id and hand
};

struct OwnRuns {
  std::size_t count = 0;             ///< of earlier runs
  std::optional<OwnRun> last, best;  ///< best: done, then with the fewest faults, then the fastest
};

/// Searches the newest reports below a folder. title: of the scene. person: field of the reports; empty: those without
/// one. Demonstrations and runs without an exercise do not count, nor does `except`.
OwnRuns own_runs(const std::filesystem::path& folder, const std::string& title, const std::string& person,
                 const std::filesystem::path& except);

}  // namespace insula
