// SPDX-License-Identifier: GPL-3.0-or-later
#include "engine/command_line/tool_program.h"

#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <filesystem>
#include <ostream>

#include "engine/live/project_folder.h"

namespace insula {

int run_tool_program(const std::string& name, const std::vector<std::string>& arguments,
                     const std::string& when_missing, std::ostream& err) {
  std::error_code error;
  const std::filesystem::path self = own_program();
  const std::filesystem::path program = self.parent_path() / name;
  if (!std::filesystem::exists(program, error)) {
    err << "error: the program " << name << " is missing beside " << self.string() << ". " << when_missing << '\n';
    return 1;
  }
  std::string path = program.string();
  std::vector<std::string> words = arguments;
  std::vector<char*> pointers{path.data()};
  for (std::string& w : words) pointers.push_back(w.data());
  pointers.push_back(nullptr);
  execv(path.c_str(), pointers.data());
  err << "error: " << path << " cannot be started: " << std::strerror(errno) << '\n';
  return 1;
}

}  // namespace insula
