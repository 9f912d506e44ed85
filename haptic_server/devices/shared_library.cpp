// SPDX-License-Identifier: GPL-3.0-or-later
// dlopen and dlsym.
#include "haptic_server/devices/shared_library.h"

#include <dlfcn.h>

#include <cstdlib>

namespace insula {

SharedLibrary::SharedLibrary(const char* variable, const std::vector<std::string>& names) {
  const char* chosen = std::getenv(variable);
  const std::vector<std::string> candidates =
      chosen != nullptr && *chosen != '\0' ? std::vector<std::string>{chosen} : names;
  for (const std::string& name : candidates) {
    handle_ = dlopen(name.c_str(), RTLD_NOW | RTLD_LOCAL);
    if (handle_ != nullptr) {
      name_ = name;
      error_.clear();
      return;
    }
    const char* why = dlerror();
    // The first name is the usual one, so its message helps most.
    if (error_.empty()) error_ = why != nullptr ? why : name + " cannot be loaded";
  }
}

void* SharedLibrary::address(const char* symbol, bool required) {
  void* found = handle_ != nullptr ? dlsym(handle_, symbol) : nullptr;
  if (found == nullptr && required && handle_ != nullptr) {
    error_ = name_ + " has no function " + symbol;
    handle_ = nullptr;
  }
  return found;
}

}  // namespace insula
