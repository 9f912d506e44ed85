// SPDX-License-Identifier: GPL-3.0-or-later
#include "engine/command_line/load_plugins.h"

#include <ostream>

#include "core/registry/plugin_loader.h"

namespace insula {

int load_plugins(Registry& registry, const std::vector<std::filesystem::path>& paths, std::ostream& err) {
  register_builtin(registry);
  std::vector<std::filesystem::path> files = plugin_files(installed_plugin_folder());
  for (const auto& path : paths) {
    if (!std::filesystem::is_directory(path)) {
      files.push_back(path);
      continue;
    }
    const auto found = plugin_files(path);
    files.insert(files.end(), found.begin(), found.end());
  }
  int status = 0;
  for (const auto& file : files) {
    const std::string error = load_plugin(registry, file);
    if (error.empty()) continue;
    err << "error: " << error << '\n';
    status = 2;
  }
  return status;
}

}  // namespace insula
