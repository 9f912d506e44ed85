// SPDX-License-Identifier: GPL-3.0-or-later
// Texts of files that are embedded in the program (cmake/embed.cmake).
#pragma once
#include <span>
#include <string_view>

namespace insula {

struct EmbeddedFile {
  std::string_view name;  ///< "constraint/NAME.cpp"
  std::string_view text;
};

/// Templates of `insula new-plugin`: the files of each kind, and those of "common", which each kind gets or may get.
std::span<const EmbeddedFile> new_plugin_files();
/// The declarations of messages, lcm_types/*.lcm.
std::span<const EmbeddedFile> message_declarations();

}  // namespace insula
