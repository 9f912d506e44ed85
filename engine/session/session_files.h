// SPDX-License-Identifier: GPL-3.0-or-later
// The files of a scene as a session keeps them: text as it is, meshes by their hash.
#pragma once
#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include "core/container/mcap_reader.h"
#include "core/container/mcap_writer.h"

namespace insula {

/// SHA-256 of bytes, or of a file, as 64 hexadecimal digits. Throws InputError if the file cannot be read.
std::string sha256(mcap::Bytes bytes);
std::string sha256_of(const std::filesystem::path& file);

/// A scene with all files that it names.
struct SceneFileList {
  std::filesystem::path root;                 ///< the folder that contains all of them
  std::string scene;                          ///< of the scene itself, relative to root
  std::map<std::string, std::string> sha256;  ///< by path relative to root, with /
};
SceneFileList list_scene_files(const std::filesystem::path& scene);

/// Writes the list, and the content of text files (XML, URDF, JSON, CSV) as attachments "scene/PATH".
void put_scene_files(McapWriter& file, const SceneFileList& list);

/// Puts the recorded scene into a folder: text from the recording, meshes from `places`, folders that are searched for
/// a file of the same path, or else of the same name, with the same hash. Returns the path of the scene. Throws
/// InputError that names all files that are missing or differ.
std::filesystem::path restore_scene_files(McapReader& file, const std::vector<std::filesystem::path>& places,
                                          const std::filesystem::path& folder);

}  // namespace insula
