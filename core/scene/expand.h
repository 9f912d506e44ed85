// SPDX-License-Identifier: GPL-3.0-or-later
// The preprocessing of scene files: <include> and <variable>, and nothing else.
//
//   <include file="parts/window.xml" prefix="left_"><variable name="width" value="30 mm"/></include>
// replaces the element by the children of that file's root (<part> or <scene>). The file is found relative to the file
// that includes it, and it must lie in the scene's root folder. `prefix` is put before every id of the part. References
// inside the part look for the prefixed id first.
//
//   <variable name="width" value="25 mm"/>   directly in <scene> or <part>; used as $width or ${width}; $$ is a dollar.
// A variable of the including file replaces the part's own of the same name. One inside the <include> replaces both.
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
  std::string shown;                  ///< as messages call it
  std::vector<std::string> prefixes;  ///< possible prefixes of an id here, innermost first, "" last
};

struct ExpandedScene {
  std::unique_ptr<Element> root;  ///< null when the main file could not be read
  std::vector<std::unique_ptr<ScenePart>> parts;
  std::filesystem::path root_folder;  ///< nothing outside of it may be read
  Fnv1a hash;                         ///< over the text of all files in the order read
  Suggestions suggestions;            ///< how much effort is left for them
};

/// The folder from which a scene may read: the nearest folder upwards of the scene file that holds a folder `meshes`,
/// else the scene's own.
std::filesystem::path scene_root_folder(const std::filesystem::path& scene_file);

/// A file named in a scene: relative to `folder`, inside `root`, existing and regular. Returns the canonical path, or
/// an empty one and the error text, with the name that was probably meant.
std::filesystem::path resolve_file(const std::filesystem::path& folder, const std::filesystem::path& root,
                                   const std::string& name, std::string& error, Suggestions& suggestions);

ExpandedScene expand_scene(std::string_view text, const std::filesystem::path& path, Diagnostics& diagnostics);

}  // namespace insula
