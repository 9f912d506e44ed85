// SPDX-License-Identifier: GPL-3.0-or-later
// insula new-plugin: a folder to begin a plugin with.
#pragma once
#include <filesystem>
#include <string>

#include "engine/command_line/commands.h"

namespace insula {

struct NewPluginOptions {
  std::string name;              ///< of the plugin and of its element: small letters, digits, _
  std::string kind;              ///< one of plugin_kinds()
  std::filesystem::path folder;  ///< to be made; empty: the name
};
/// The kinds that it knows: "constraint, force, ... or exercise".
std::string plugin_kinds();
/// Writes source, test, example, build file and README. Nothing is written when the name does not serve or the folder
/// exists and is not empty (status 2); status 1 when a file cannot be written.
int cmd_new_plugin(const CommandContext& context, const NewPluginOptions& options);

}  // namespace insula
