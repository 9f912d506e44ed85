// SPDX-License-Identifier: GPL-3.0-or-later
// Statements of the Experience API about a run. Source: xAPI 1.0.3, part two (Experience API Data), and the verbs and
// activity types of ADL's vocabulary.
#pragma once
#include <functional>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "training/store/records.h"

namespace insula::xapi {

using Json = nlohmann::ordered_json;

inline constexpr const char* version = "1.0.3";  ///< of the specification

/// What statements say beside the run.
struct Origin {
  std::string home_page;  ///< IRL of this installation: the accounts of its persons belong to it
  /// What is to be done in a scene, by the scene's name; empty: not known. May be missing.
  std::function<std::string(const std::string& scene)> description = {};
};

/// The IRI of an exercise. A scene of the project has the same one everywhere. A file elsewhere belongs to its
/// installation, and its folders are not told.
std::string activity_of(const std::string& scene, const std::string& home_page);

/// Of a run with metrics and faults, in order of time: "attempted", and how it ended unless it was left before.
/// A test ends with "passed" or "failed", practice with "completed" or "failed". The ids follow from the run alone.
/// Empty if the run is no attempt. Throws InputError if the run's uuid or the home page is not valid.
std::vector<Json> statements_of(const training::Run& run, const Origin& origin);

}  // namespace insula::xapi
