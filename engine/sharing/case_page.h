// SPDX-License-Identifier: GPL-3.0-or-later
// A folder of cases as a page that any web server or disk can hold: index.html, pictures, and each case to be loaded.
#pragma once
#include <filesystem>
#include <string>
#include <vector>

#include "engine/sharing/case_archive.h"
#include "engine/sharing/case_list.h"

namespace insula {

/// Packs a case with its pictures and reports.
PackedCase pack_listed(const ListedCase& listed, const std::filesystem::path& project,
                       const std::filesystem::path& archive);

/// Writes index.html, NAME.zip and NAME.jpg of each case into a folder, which is created. Throws InputError.
void write_case_page(const std::vector<ListedCase>& cases, const std::filesystem::path& project,
                     const std::filesystem::path& folder);

}  // namespace insula
