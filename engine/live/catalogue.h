// SPDX-License-Identifier: GPL-3.0-or-later
// The exercises that the start page offers: the scenes of the project's folder that have an exercise.
#pragma once
#include <filesystem>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

namespace insula {

struct CatalogueEntry {
  std::string scene;    ///< name of the file (project_folder.h)
  std::string group;    ///< "skills", "training" or "cases"
  std::string of_case;  ///< the same for all exercises of one case; empty: it stands alone
  std::string id;       ///< of the exercise; empty: not said
  std::string name;     ///< title of the exercise
  std::string title;    ///< of the scene
  std::string text;     ///< what is to be done
  std::string site;     ///< of the aneurysm, as Exercise has it; empty: not said
  int difficulty = 0;   ///< from 1 to 5; 0: not said
  std::string picture;  ///< file beside the scene, NAME.jpg; empty: there is none
};

/// What a file says of its exercise, if it is a scene with one; file's name, group and case are not set.
std::optional<CatalogueEntry> catalogue_entry(const std::filesystem::path& scene);
/// All exercises below folder/scenes: first skills, then training, then cases, each in the order of their files' names.
/// A file that cannot be read is left out, since a start page shows what works. Only titles and texts are read, so a
/// folder of hundreds takes no time.
std::vector<CatalogueEntry> catalogue(const std::filesystem::path& folder);
nlohmann::ordered_json catalogue_json(const std::vector<CatalogueEntry>& entries);

}  // namespace insula
