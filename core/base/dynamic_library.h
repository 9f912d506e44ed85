// SPDX-License-Identifier: GPL-3.0-or-later
// A shared library that is loaded while the program runs. The implementation belongs to the operating system
// (platform/).
#pragma once
#include <filesystem>
#include <string>
#include <string_view>

namespace insula {

/// How the names of shared libraries end, with the dot.
std::string_view dynamic_library_ending();
/// Whether the file begins as a shared library of this system does.
bool begins_as_dynamic_library(const std::filesystem::path& file);

/// Stays loaded until unload() or the end of the process, whatever happens to the object.
class DynamicLibrary {
 public:
  /// Looks for nothing but this file. Afterwards either loaded() holds or error() says why not.
  explicit DynamicLibrary(const std::filesystem::path& file);
  /// The library of that name and version, without prefix and ending, from the system's folders.
  static DynamicLibrary of_system(std::string_view name, int version);

  bool loaded() const { return handle_ != nullptr; }
  const std::string& error() const { return error_; }
  /// The function of that name, or null.
  template <class Function>
  Function* function(const char* name) const {
    return reinterpret_cast<Function*>(address(name));
  }
  void unload();

 private:
  DynamicLibrary() = default;
  void* address(const char* name) const;

  void* handle_ = nullptr;
  std::string error_;
};

}  // namespace insula
