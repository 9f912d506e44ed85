// SPDX-License-Identifier: GPL-3.0-or-later
// The curricula that the start page offers: those beside the scenes, and those of the user's data.
#pragma once
#include <filesystem>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "engine/authoring/curriculum_sources.h"
#include "training/curriculum/curriculum.h"

namespace insula {

struct ListedCurriculum {
  std::string id;  ///< name of its file, without folder and extension
  std::filesystem::path file;
  std::optional<Curriculum> curriculum;  ///< none: it has errors
  std::string problem;                   ///< the errors
};

/// All curricula of the folders, by id. A later folder's curriculum takes the place of an earlier one's of the same id.
std::vector<ListedCurriculum> list_curricula(const std::vector<std::filesystem::path>& folders,
                                             CurriculumFiles& sources);
/// The folders that are searched: `curricula` of the project, then of the user's data.
std::vector<std::filesystem::path> curriculum_folders(const std::filesystem::path& data);

/// {"version", "project": folder that scenes are named from, "curricula": [{"id", "problem", "curriculum"}],
///  "scenes": {name in curricula: {"scene": name of the file, "title"}}}; training/progress/curriculum_json.h
nlohmann::ordered_json curriculum_list_json(const std::vector<ListedCurriculum>& list, const CurriculumFiles& sources);

}  // namespace insula
