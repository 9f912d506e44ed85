// SPDX-License-Identifier: GPL-3.0-or-later
// Walks a PLY file and checks that everything its header announces is there.
#pragma once
#include <filesystem>
#include <string_view>

namespace insula {

/// Throws InputError: malformed header, truncated, a face that names a missing vertex, a coordinate that is not finite.
void check_ply(const std::filesystem::path& file, std::string_view bytes);

}  // namespace insula
