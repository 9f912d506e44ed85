// SPDX-License-Identifier: GPL-3.0-or-later
// A case as one .zip file: its scenes with every file that they name, in the layout of their folders. What comes from
// elsewhere is checked before it is written: names, kinds, sizes and hashes. Nothing of it is ever executed.
#pragma once
#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "core/base/case_name.h"

namespace insula {

/// The list of contents in the archive and in an unpacked case:
/// {"format": 1, "name", "scenes": [path], "files": {path: SHA-256}}, paths relative, with /.
inline constexpr const char* case_manifest = "insula_case.json";

inline constexpr std::uint64_t max_case_file_bytes = 100'000'000;
inline constexpr std::uint64_t max_case_bytes = 500'000'000;
inline constexpr std::uint64_t max_case_files = 5000;

struct PackedCase {
  std::string name;
  std::vector<std::string> scenes;  ///< paths in the archive
  std::size_t files = 0;
  std::uint64_t bytes = 0;  ///< unpacked
};

/// Writes the scenes, what they name, and `more` files. The same files give the same bytes. Whether the scenes load is
/// not checked here. Throws InputError: a wrong name, a scene that is not there, a file of a kind that no case has.
PackedCase pack_case(const std::string& name, const std::vector<std::filesystem::path>& scenes,
                     const std::vector<std::filesystem::path>& more, const std::filesystem::path& archive);

/// Unpacks into folder/NAME, which must not be there. Throws InputError, and then leaves nothing behind.
PackedCase unpack_case(const std::filesystem::path& archive, const std::filesystem::path& folder);

}  // namespace insula
