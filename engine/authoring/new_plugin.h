// SPDX-License-Identifier: GPL-3.0-or-later
// insula new-plugin: creates a folder for a new plugin.
#pragma once
#include <filesystem>
#include <string>

#include "engine/command_line/commands.h"

namespace insula {

struct NewPluginOptions {
  std::string name;              ///< of the plugin and of its element: small letters, digits, _
  std::string kind;              ///< one of plugin_kinds()
  std::filesystem::path folder;  ///< created; empty: the name
};
/// The kinds of plugins: "constraint, force, ... or exercise".
std::string plugin_kinds();
/// Writes source, test, example, build file and README. Writes nothing, with status 2, if the name is not valid or the
/// folder exists and is not empty. Status 1 if a file cannot be written.
int cmd_new_plugin(const CommandContext& context, const NewPluginOptions& options);

}  // namespace insula
