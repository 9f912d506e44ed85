// SPDX-License-Identifier: GPL-3.0-or-later
// The cases of this installation: those of the project, and those that the user has added from archives.
#pragma once
#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "engine/live/catalogue.h"

namespace insula {

/// The folder of added cases in the user's data.
std::filesystem::path added_cases_folder(const std::filesystem::path& data);

struct ListedCase {
  std::string name;
  std::filesystem::path folder;           ///< of its scenes
  bool added = false;                     ///< from an archive
  std::vector<CatalogueEntry> exercises;  ///< one at least
  nlohmann::json report;                  ///< report.json of the case builder; null: there is none

  const std::string& title() const { return exercises.front().title; }
  const std::string& site() const { return exercises.front().site; }
  int difficulty() const { return exercises.front().difficulty; }
};

/// By name. project: the folder with scenes/. A scene in scenes/cases is a case, and so is a folder of scenes there.
std::vector<ListedCase> list_cases(const std::filesystem::path& project, const std::filesystem::path& data);

/// The case of a folder that the case builder wrote, named as the folder. Throws InputError if it has no exercise.
ListedCase built_case(const std::filesystem::path& folder);

/// Exercises of the added cases, for the start page. Scenes are absolute paths.
std::vector<CatalogueEntry> added_exercises(const std::filesystem::path& data);

/// Of the exercise, or the name of the scene's file if it has none.
std::string exercise_id(const CatalogueEntry& exercise);

/// [{name, added, site, difficulty, title, folder, report,
///   exercises: [{id, name, scene, title, difficulty, text, picture}]}]
nlohmann::ordered_json cases_json(const std::vector<ListedCase>& cases);

}  // namespace insula
