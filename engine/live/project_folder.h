// SPDX-License-Identifier: GPL-3.0-or-later
// Where the project's scenes and curricula are: beside the program's installation or sources.
#pragma once
#include <filesystem>
#include <string>

namespace insula {

/// The folder that contains scenes/: the current one, else that of the sources or of the installation of this program.
/// Empty: there is none.
std::filesystem::path project_folder();

/// How a scene is named in the training store and in curricula: relative to the project's folder if it is below it,
/// else absolute. Equal for equal files, whatever the current folder.
std::string scene_name(const std::filesystem::path& scene);
/// The file of such a name.
std::filesystem::path scene_file(const std::string& name);

}  // namespace insula
