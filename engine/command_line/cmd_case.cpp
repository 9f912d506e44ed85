// SPDX-License-Identifier: GPL-3.0-or-later
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <filesystem>
#include <ostream>

#include "engine/command_line/case_command.h"

namespace insula {

int cmd_case(const std::vector<std::string>& arguments, std::ostream& err) {
  std::error_code error;
  const std::filesystem::path self = std::filesystem::read_symlink("/proc/self/exe", error), program = self.parent_path() / "insula_case";
  if (!std::filesystem::exists(program, error)) {
    err << "error: the case builder is not built here: it needs CGAL (Debian: libcgal-dev), and ITK for volumes (libinsighttoolkit5-dev). Install them, then build again.\n";
    return 1;
  }
  std::string name = program.string();
  std::vector<std::string> words = arguments;
  std::vector<char*> pointers{name.data()};
  for (std::string& w : words) pointers.push_back(w.data());
  pointers.push_back(nullptr);
  execv(name.c_str(), pointers.data());
  err << "error: " << name << " cannot be started: " << std::strerror(errno) << '\n';
  return 1;
}

}  // namespace insula
