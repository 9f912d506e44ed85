// SPDX-License-Identifier: GPL-3.0-or-later
// What the programs `insula` and `insula_workbench` do with their command lines.
#pragma once
#include <CLI/CLI.hpp>

#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "engine/command_line/commands.h"

namespace insula {

/// The options of a program, and the command that they choose. Options are read into members of a subclass, so it must
/// stay where it is.
struct CommandLine {
  CommandLine(const std::string& description, const std::string& name);
  CommandLine(const CommandLine&) = delete;
  CommandLine& operator=(const CommandLine&) = delete;

  CLI::App app;
  std::vector<std::filesystem::path> plugin_paths;
  std::function<int(const CommandContext&)> chosen;  ///< set by the callback of a subcommand
};

/// Reads the words, loads the plugins and runs the chosen command. Returns the exit status: 2 for wrong words, 1 when a
/// command throws; its message goes to the standard error stream.
int run_command_line(CommandLine& line, int argc, char** argv);

}  // namespace insula
