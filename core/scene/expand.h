// SPDX-License-Identifier: GPL-3.0-or-later
// The preprocessing of scene files: only <include> and <variable>.
//
//   <include file="parts/window.xml" prefix="left_"><variable name="width" value="30 mm"/></include>
// replaces the element by the children of that file's root (<part> or <scene>). The file is found relative to the file
// that includes it, and it must lie in the scene's root folder. `prefix` is put before every id of the part. References
// inside the part look for the prefixed id first.
//
//   <variable name="width" value="25 mm"/>   directly in <scene> or <part>; used as $width or ${width}; $$ is a dollar.
// A variable of the including file replaces a variable of the part with the same name. A variable inside the <include>
// replaces both.
#pragma once
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "core/base/text.h"
#include "core/scene/suggestions.h"
#include "core/xml/document.h"

namespace insula {

/// One inclusion of a file.
struct ScenePart {
  std::filesystem::path path;         ///< canonical
  std::string shown;                  ///< name in messages
  std::vector<std::string> prefixes;  ///< possible prefixes of an id here, innermost first, "" last
};

struct ExpandedScene {
  std::unique_ptr<Element> root;  ///< null when the main file could not be read
  std::vector<std::unique_ptr<ScenePart>> parts;
  std::filesystem::path root_folder;  ///< no file outside of it may be read
  Fnv1a hash;                         ///< over the text of all files in the order read
  Suggestions suggestions;            ///< remaining effort for suggestions
};

/// The folder from which a scene may read: the nearest folder above the scene file that contains a folder `meshes`, or
/// else the scene's own folder.
std::filesystem::path scene_root_folder(const std::filesystem::path& scene_file);

/// A file named in a scene: relative to `folder`, inside `root`, existing and regular. Returns the canonical path. On
/// an error it returns an empty path and the error text, with a suggested name.
std::filesystem::path resolve_file(const std::filesystem::path& folder, const std::filesystem::path& root,
                                   const std::string& name, std::string& error, Suggestions& suggestions);

struct SceneEdit;

/// edits: those that name a variable replace it in the whole scene.
ExpandedScene expand_scene(std::string_view text, const std::filesystem::path& path, Diagnostics& diagnostics,
                           const std::vector<SceneEdit>& edits);
ExpandedScene expand_scene(std::string_view text, const std::filesystem::path& path, Diagnostics& diagnostics);

}  // namespace insula
