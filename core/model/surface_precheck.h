// SPDX-License-Identifier: GPL-3.0-or-later
// Checks of a surface file's bytes before assimp sees them: it takes truncated files for empty or shorter ones.
#pragma once
#include <filesystem>
#include <string_view>

namespace insula {

/// Extension known, announced counts against the bytes that follow (STL, PLY, GLB, OFF), PLY face indices in range.
/// Throws InputError.
void precheck_surface(const std::filesystem::path& file, std::string_view bytes);

}  // namespace insula
