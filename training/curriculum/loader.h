// SPDX-License-Identifier: GPL-3.0-or-later
// From a curriculum file to a checked curriculum. Includes and variables are those of scenes.
//
// All errors are found and reported together, in order of file and position, those of its scenes too. A curriculum is
// returned only if there are none. No exception of a bad file leaves these functions.
#pragma once
#include <filesystem>
#include <optional>
#include <string_view>

#include "core/base/diagnostic.h"
#include "training/curriculum/curriculum.h"
#include "training/curriculum/sources.h"

namespace insula {

struct CurriculumResult {
  std::optional<Curriculum> curriculum;  ///< none when diagnostics has an error
  Diagnostics diagnostics;
};

CurriculumResult load_curriculum(const std::filesystem::path& file, CurriculumSources& sources);
/// The same for a text. Relative paths in it are read from the folder of `virtual_path`, which need not exist.
CurriculumResult load_curriculum_text(std::string_view text, const std::filesystem::path& virtual_path,
                                      CurriculumSources& sources);

/// Whether the root element of a file is <curriculum>, or nearest to it among the roots that there are. Files that
/// cannot be read are none.
bool is_curriculum_file(const std::filesystem::path& file);

}  // namespace insula
