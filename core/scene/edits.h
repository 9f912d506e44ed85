// SPDX-License-Identifier: GPL-3.0-or-later
// Values that come from outside of a scene's files, such as from a study: they take the place of what the files say.
// They are checked like attributes, and messages name the place where they were written.
#pragma once
#include <filesystem>
#include <string>
#include <vector>

#include "core/scene/loader.h"

namespace insula {

struct ExpandedScene;

struct SceneEdit {
  std::string component;  ///< id, or ID.ELEMENT for its only child of that element; empty: `name` is a variable
  std::string name;       ///< of the parameter or variable
  std::string value;
  SourcePos pos;  ///< where it was written
};

/// load_scene(), or load_scene_text() if `text` is not empty, with these values. The scene's hash covers them.
LoadResult load_scene_edited(std::string_view text, const std::filesystem::path& file, const Registry& registry,
                             const std::vector<SceneEdit>& edits, double time_step_s = 0);

/// load_scene_with_exercise_of() with these values.
LoadResult load_scene_edited_with_exercise_of(const std::filesystem::path& rules, const std::filesystem::path& file,
                                              const Registry& registry, const std::vector<SceneEdit>& edits,
                                              double time_step_s = 0);

/// Sets parameters in an expanded scene. A component without an id is called by its element and ordinal, as in reports.
void apply_edits(ExpandedScene& tree, const std::vector<SceneEdit>& edits, Diagnostics& diagnostics);

}  // namespace insula
