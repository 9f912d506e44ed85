// SPDX-License-Identifier: GPL-3.0-or-later
// Checks the references inside the JSON of a glTF file (Khronos, glTF 2.0 specification, chapters 3.5 to 3.7).
#pragma once
#include <filesystem>
#include <string_view>

namespace insula {

/// Throws InputError: malformed JSON, indices out of range, a node that is its own ancestor, views outside their
/// buffers. Returns the number of triangles that the meshes announce, or 0 if there are strips or fans.
std::size_t check_gltf(const std::filesystem::path& file, std::string_view json);

}  // namespace insula
