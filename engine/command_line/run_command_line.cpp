// SPDX-License-Identifier: GPL-3.0-or-later
#include "engine/command_line/run_command_line.h"

#include <algorithm>
#include <iostream>
#include <string>

#include "core/params/option.h"
#include "core/registry/registry.h"
#include "engine/command_line/load_plugins.h"

namespace insula {
namespace {

/// What a report of a fault should name: the version, and what a shared plugin must have been built with.
std::string version_text() {
  return std::string("insula " INSULA_VERSION
                     ", a simulator for training in aneurysm surgery\n"
                     "For training only, never for the care of patients. GPL-3.0-or-later, without warranty.\n"
                     "Shared plugins must be built for: ") +
         abi_string();
}

}  // namespace

CommandLine::CommandLine(const std::string& description, const std::string& name) : app(description, name) {
  app.require_subcommand(1);
  app.set_version_flag("--version", version_text(), "what this program is, and what shared plugins must be built for");
  app.add_option("--plugin-path", plugin_paths, "folder of shared plugins, or one plugin (may be given more than once)")
      ->allow_extra_args(false);
}

int run_command_line(CommandLine& line, int argc, char** argv) {
  try {
    std::vector<std::string> words = command_words(argc, argv);
    std::reverse(words.begin(), words.end());  // as CLI11 takes them
    line.app.parse(std::move(words));
  } catch (const CLI::ParseError& e) {
    return line.app.exit(e) == 0 ? 0 : 2;
  }
  try {
    Registry registry;
    if (const int status = load_plugins(registry, line.plugin_paths, std::cerr)) return status;
    return line.chosen({registry, std::cout, std::cerr});
  } catch (const std::exception& e) {
    std::cerr << "error: " << e.what() << '\n';
    return 1;
  }
}

}  // namespace insula
