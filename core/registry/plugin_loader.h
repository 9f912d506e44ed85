// SPDX-License-Identifier: GPL-3.0-or-later
// Folders in which shared plugins are searched. registry.h declares `load_plugin` itself.
#pragma once
#include <filesystem>
#include <vector>

namespace insula {

/// The `.so` files of a folder by name; empty when there is no such folder.
std::vector<std::filesystem::path> plugin_files(const std::filesystem::path& folder);
/// <prefix>/lib/insula/plugins for a program in <prefix>/bin.
std::filesystem::path installed_plugin_folder();

}  // namespace insula
