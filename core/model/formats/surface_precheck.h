// SPDX-License-Identifier: GPL-3.0-or-later
// Checks of a surface file's bytes before assimp reads them. assimp accepts truncated files as empty or shorter ones.
#pragma once
#include <filesystem>
#include <string_view>

namespace insula {

/// Checks the extension, the announced counts against the following bytes (STL, PLY, GLB, OFF), the face indices of PLY
/// and OFF, and the references within glTF. Throws InputError. Returns the expected number of triangles if the file
/// states it, else 0.
std::size_t precheck_surface(const std::filesystem::path& file, std::string_view bytes);

}  // namespace insula
