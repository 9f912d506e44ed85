// SPDX-License-Identifier: GPL-3.0-or-later
// Loading shared plugins. They come from the installation's folder or from --plugin-path, never from a scene.
#include "core/registry/plugin_loader.h"

#include <dlfcn.h>

#include <algorithm>
#include <cstring>
#include <fstream>

#include "core/registry/registry.h"

namespace insula {
namespace {

bool is_elf(const std::filesystem::path& file) {
  char magic[4] = {};
  std::ifstream in(file, std::ios::binary);
  return in.read(magic, 4) && std::memcmp(magic, "\177ELF", 4) == 0;
}

template <class F>
F* symbol(void* handle, const char* name) {
  return reinterpret_cast<F*>(dlsym(handle, name));
}

}  // namespace

std::string load_plugin(Registry& registry, const std::filesystem::path& so) {
  const std::string name = so.string();
  std::error_code ec;
  if (!std::filesystem::exists(so, ec)) return name + ": no such file";
  if (!std::filesystem::is_regular_file(so, ec)) return name + ": is not a file";
  if (!is_elf(so)) return name + ": is not a shared library";
  // An absolute path keeps dlopen from searching the system's folders. The library stays loaded until the process ends,
  // since its components refer to its code.
  const auto absolute = std::filesystem::absolute(so, ec);
  void* handle = dlopen(absolute.c_str(), RTLD_NOW | RTLD_LOCAL);
  if (!handle) {
    const char* why = dlerror();
    return name + ": cannot be loaded: " + (why ? why : "unknown reason");
  }
  using Text = const char*();
  using Register = void(Registry*);
  auto* abi = symbol<Text>(handle, "insula_plugin_abi");
  auto* plugin_name = symbol<Text>(handle, "insula_plugin_name");
  auto* add = symbol<Register>(handle, "insula_plugin_register");
  const auto refuse = [&](std::string text) {
    dlclose(handle);
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
    if (entry.path().extension() == ".so") files.push_back(entry.path());
  std::sort(files.begin(), files.end());
  return files;
}

std::filesystem::path installed_plugin_folder() {
  std::error_code ec;
  const auto program = std::filesystem::read_symlink("/proc/self/exe", ec);
  if (ec) return {};
  return program.parent_path().parent_path() / "lib" / "insula" / "plugins";
}

}  // namespace insula
