// SPDX-License-Identifier: GPL-3.0-or-later
#include "engine/command_line/run_command_line.h"

#include <fmt/ranges.h>

#include <algorithm>
#include <iostream>
#include <string>

#include "core/base/diagnostic.h"
#include "core/base/text.h"
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

/// Error text if the word in the command's place is no command; empty otherwise.
std::string unknown_command(const CLI::App& app, const std::vector<std::string>& words) {
  const auto takes_value = [](const std::string& word) { return word == "--plugin-path"; };
  auto word = words.begin();
  while (word != words.end() && word->starts_with('-')) word += takes_value(*word) && word + 1 != words.end() ? 2 : 1;
  if (word == words.end()) return "";
  std::vector<std::string> names;
  for (const CLI::App* command : app.get_subcommands({})) names.push_back(command->get_name());
  if (std::find(names.begin(), names.end(), *word) != names.end()) return "";
  const std::string near = nearest_name(*word, names);
  const std::string hint = near.empty() ? fmt::format("; there are {}", fmt::join(names, ", ")) : did_you_mean(near);
  return "no command " + in_quotes(*word) + hint;
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
    if (const std::string error = unknown_command(line.app, words); !error.empty()) {
      std::cerr << error << "\nRun with --help for more information.\n";
      return 2;
    }
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
