// SPDX-License-Identifier: GPL-3.0-or-later
// From a scene file to checked components.
//
// All errors are found and reported together, in order of file and position. A scene is returned only if there are
// none. No exception leaves these functions, whatever the file contains.
#pragma once
#include <filesystem>
#include <memory>
#include <string_view>

#include "core/base/diagnostic.h"
#include "core/registry/registry.h"
#include "core/scene/scene.h"

namespace insula {

struct LoadResult {
  std::unique_ptr<Scene> scene;  ///< null when diagnostics has an error
  Diagnostics diagnostics;

  bool ok() const { return scene != nullptr; }
};

/// time_step_s replaces the scene's own step, for comparisons; 0: the scene's own.
LoadResult load_scene(const std::filesystem::path& file, const Registry& registry, double time_step_s = 0);

/// The same with the exercise of another scene in place of its own, to score recorded runs by other rules. The motions
/// of that exercise are left out.
LoadResult load_scene_with_exercise_of(const std::filesystem::path& rules, const std::filesystem::path& file,
                                       const Registry& registry, double time_step_s = 0);

/// The same for a text. Relative paths in it are read from the folder of `virtual_path`, which need not exist.
LoadResult load_scene_text(std::string_view text, const std::filesystem::path& virtual_path, const Registry& registry,
                           double time_step_s = 0);

}  // namespace insula
