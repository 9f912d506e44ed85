// SPDX-License-Identifier: GPL-3.0-or-later
#include "engine/command_line/study_command.h"

#include <unistd.h>

#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <ostream>

#include "engine/live/project_folder.h"

namespace insula {
namespace {

// A build folder has the package beside the programs.
constexpr const char* program = R"(
import sys
beside, words = sys.argv[1], sys.argv[2:]
sys.path[0] = beside
try:
    from insula.studies.command import main
except ImportError as error:
    sys.exit(f"error: {error}: insula study needs the Python package (pip install insula-*.whl, docs/python.md); "
             "INSULA_PYTHON names the Python that has it")
sys.exit(main(words))
)";

/// INSULA_PYTHON, that of the source tree in which the program was built, or the first one in PATH.
std::string python_of(const std::filesystem::path& release) {
  if (const char* python = std::getenv("INSULA_PYTHON"); python && *python) return python;
  const std::filesystem::path own = release.parent_path() / "python-env/bin/python";
  std::error_code error;
  return std::filesystem::exists(own, error) ? own.string() : "python3";
}

/// Replaces this process. Returns only if that fails.
int run_study(const std::vector<std::string>& words, std::ostream& err) {
  const std::filesystem::path release = own_program().parent_path().parent_path();
  std::vector<std::string> command{"/usr/bin/env", python_of(release), "-B", "-c", program};
  command.push_back((release / "python").string());
  command.insert(command.end(), words.begin(), words.end());
  std::vector<char*> pointers;
  for (std::string& word : command) pointers.push_back(word.data());
  pointers.push_back(nullptr);
  execv(pointers[0], pointers.data());
  err << "error: " << command[1] << " cannot be started: " << std::strerror(errno) << '\n';
  return 1;
}

}  // namespace

void add_study_command(CommandLine& line) {
  auto* command = line.app.add_subcommand("study", "sweeps of scenes, parameters and seeds, here or on a cluster")
                      ->prefix_command();
  command->set_help_flag();
  command->callback([&line, command] {
    line.chosen = [words = command->remaining()](const CommandContext& context) {
      return run_study(words, context.err);
    };
  });
}

}  // namespace insula
