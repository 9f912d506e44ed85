// SPDX-License-Identifier: GPL-3.0-or-later
// Checks of a surface file's bytes before assimp sees them: it takes truncated files for empty or shorter ones.
#pragma once
#include <filesystem>
#include <string_view>

namespace insula {

/// Extension known, announced counts against the bytes that follow (STL, PLY, GLB, OFF), face indices of PLY and
/// OFF, references within glTF.
/// Throws InputError. Returns the number of triangles to expect where the file says it, else 0.
std::size_t precheck_surface(const std::filesystem::path& file, std::string_view bytes);

}  // namespace insula
