// SPDX-License-Identifier: GPL-3.0-or-later
// The files of a scene, also of one with errors. A running session watches them.
#pragma once
#include <filesystem>
#include <vector>

namespace insula {

/// The scene, its included files, and every file that a value in them names. If a file names others itself (URDF,
/// JSON), its whole folder counts. A value that looks like a file name counts even if there is no such file yet. Paths
/// are absolute, sorted and unique.
std::vector<std::filesystem::path> scene_files(const std::filesystem::path& scene);

}  // namespace insula
