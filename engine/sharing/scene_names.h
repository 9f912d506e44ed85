// SPDX-License-Identifier: GPL-3.0-or-later
// Short names of scenes, for people who type them.
#pragma once
#include <filesystem>
#include <functional>
#include <string>
#include <vector>

namespace insula {

struct NamedScene {
  std::string name;
  std::filesystem::path file;
};

/// The scenes of a project's folder: exercises, skill tasks, cases. "clipping" is scenes/training/3_clipping.xml,
/// "basilar_tip" the scene scenes/cases/basilar_tip/case.xml, and "basilar_tip/pause" another one beside it.
std::vector<NamedScene> shipped_scenes(const std::filesystem::path& project);

/// The exercises of cases that were added to the user's data (default: the platform's folder), by the same rule.
std::vector<NamedScene> added_scenes(const std::filesystem::path& data);

/// `given` itself if it is a file or ends as one, else the file of the scene that is called so. Names of files without
/// their ending count as well, such as "3_clipping". `scenes` reads many files, so only a name asks for it. Throws
/// InputError with the nearest name if there is none.
std::filesystem::path scene_called(const std::string& given, const std::function<std::vector<NamedScene>()>& scenes);

}  // namespace insula
