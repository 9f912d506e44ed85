// SPDX-License-Identifier: GPL-3.0-or-later
// Walks a PLY file, checks that everything its header announces is there, and changes its byte order.
#pragma once
#include <filesystem>
#include <string>
#include <string_view>

namespace insula {

/// Throws InputError: malformed header, truncated, a face that names a missing vertex, a coordinate that is not finite.
void check_ply(const std::filesystem::path& file, std::string_view bytes);

/// Whether the data of a binary file begin with a byte that ends a line. assimp takes such a byte for a part of the
/// header (5.2 the first one, 5.4 all that follow each other).
bool begins_with_line_end(std::string_view ply);
/// The same binary file in the opposite byte order. Throws InputError as check_ply does.
std::string with_opposite_byte_order(const std::filesystem::path& file, std::string_view bytes);

}  // namespace insula
