// SPDX-License-Identifier: GPL-3.0-or-later
// The files that a scene is made of, also of one that has errors: what a running session watches.
#pragma once
#include <filesystem>
#include <vector>

namespace insula {

/// The scene, what it includes, and every file that a value in them names; of a file that names others itself (URDF,
/// JSON) its whole folder. A value that looks like a file's name counts although there is no such file yet. Absolute,
/// sorted, each once.
std::vector<std::filesystem::path> scene_files(const std::filesystem::path& scene);

}  // namespace insula
