// SPDX-License-Identifier: GPL-3.0-or-later
// Where this program is, and the project's scenes and curricula beside its installation or sources.
#pragma once
#include <filesystem>
#include <string>

namespace insula {

/// This program's file.
std::filesystem::path own_program();

/// The folder that contains scenes/: the current one, else that of the sources or of the installation of this program.
/// Empty: there is none.
std::filesystem::path project_folder();

/// How a scene is named in the training store and by pages: relative to the project's folder if it is below it, else
/// absolute. Equal for equal files, whatever the current folder, and scene_file() finds the file again. Curricula name
/// scenes by scene_key() (training/curriculum/curriculum.h), which is the same for copies of a project in other
/// folders.
std::string scene_name(const std::filesystem::path& scene);
/// The file of such a name.
std::filesystem::path scene_file(const std::string& name);

}  // namespace insula
