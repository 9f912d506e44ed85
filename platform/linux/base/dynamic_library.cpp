// SPDX-License-Identifier: GPL-3.0-or-later
// dlopen and dlsym.
#include "core/base/dynamic_library.h"

#include <dlfcn.h>

#include <cstring>
#include <fstream>
#include <string>

namespace insula {

std::string_view dynamic_library_ending() { return ".so"; }

bool begins_as_dynamic_library(const std::filesystem::path& file) {
  char magic[4] = {};
  std::ifstream in(file, std::ios::binary);
  return in.read(magic, 4) && std::memcmp(magic, "\177ELF", 4) == 0;
}

DynamicLibrary::DynamicLibrary(const std::filesystem::path& file) {
  // An absolute path keeps dlopen from searching the system's folders.
  std::error_code failed;
  handle_ = ::dlopen(std::filesystem::absolute(file, failed).c_str(), RTLD_NOW | RTLD_LOCAL);
  if (handle_ != nullptr) return;
  const char* why = ::dlerror();
  error_ = why != nullptr ? why : "unknown reason";
}

DynamicLibrary DynamicLibrary::of_system(std::string_view name, int version) {
  DynamicLibrary library;
  const std::string file = "lib" + std::string(name) + ".so." + std::to_string(version);
  library.handle_ = ::dlopen(file.c_str(), RTLD_NOW | RTLD_LOCAL);
  if (library.handle_ != nullptr) return library;
  const char* why = ::dlerror();
  library.error_ = why != nullptr ? why : "unknown reason";
  return library;
}

void* DynamicLibrary::address(const char* name) const { return handle_ != nullptr ? ::dlsym(handle_, name) : nullptr; }

void DynamicLibrary::unload() {
  if (handle_ != nullptr) ::dlclose(handle_);
  handle_ = nullptr;
}

}  // namespace insula
