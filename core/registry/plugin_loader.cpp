// SPDX-License-Identifier: GPL-3.0-or-later
// Loading shared plugins. They come from the installation's folder or from --plugin-path, never from a scene.
#include "core/registry/plugin_loader.h"

#include <algorithm>
#include <cstring>

#include "core/base/dynamic_library.h"
#include "core/base/this_process.h"
#include "core/registry/registry.h"

namespace insula {

std::string load_plugin(Registry& registry, const std::filesystem::path& so) {
  const std::string name = so.string();
  std::error_code ec;
  if (!std::filesystem::exists(so, ec)) return name + ": no such file";
  if (!std::filesystem::is_regular_file(so, ec)) return name + ": is not a file";
  if (!begins_as_dynamic_library(so)) return name + ": is not a shared library";
  // The library stays loaded until the process ends, since its components refer to its code.
  DynamicLibrary library(so);
  if (!library.loaded()) return name + ": cannot be loaded: " + library.error();
  using Text = const char*();
  using Register = void(Registry*);
  auto* abi = library.function<Text>("insula_plugin_abi");
  auto* plugin_name = library.function<Text>("insula_plugin_name");
  auto* add = library.function<Register>("insula_plugin_register");
  const auto refuse = [&](std::string text) {
    library.unload();
    return name + ": " + text;
  };
  if (!abi || !plugin_name || !add) return refuse("is not an Insula plugin (INSULA_PLUGIN is missing)");
  if (std::strcmp(abi(), abi_string()) != 0)
    return refuse("was built for another Insula: plugin \"" + std::string(abi()) + "\", program \"" + abi_string() +
                  "\"; build the plugin again with this program's headers and compiler");
  // Registers into a copy first, so that a plugin that fails leaves no elements.
  Registry extended = registry;
  extended.set_current_plugin(plugin_name());
  try {
    add(&extended);
  } catch (const std::exception& e) {
    return name + ": cannot be registered: " + e.what();
  }
  extended.set_current_plugin("core");
  registry = std::move(extended);
  return {};
}

std::vector<std::filesystem::path> plugin_files(const std::filesystem::path& folder) {
  std::vector<std::filesystem::path> files;
  std::error_code ec;
  for (const auto& entry : std::filesystem::directory_iterator(folder, ec))
    if (entry.path().extension() == dynamic_library_ending()) files.push_back(entry.path());
  std::sort(files.begin(), files.end());
  return files;
}

std::filesystem::path installed_plugin_folder() {
  const auto program = program_file();
  if (program.empty()) return {};
  return program.parent_path().parent_path() / "lib" / "insula" / "plugins";
}

}  // namespace insula
