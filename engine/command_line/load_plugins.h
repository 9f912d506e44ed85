// SPDX-License-Identifier: GPL-3.0-or-later
// The elements that a command may use: built-in ones, installed ones, and those named on the command line.
#pragma once
#include <filesystem>
#include <iosfwd>
#include <vector>

#include "core/registry/registry.h"

namespace insula {

/// Fills the registry with the built-in elements, then the installation's plugins, then those of `paths` (folders of
/// shared plugins, or single ones). Status 0, or 2 if a plugin does not load. Each reason goes to `err`.
int load_plugins(Registry& registry, const std::vector<std::filesystem::path>& paths, std::ostream& err);

}  // namespace insula
