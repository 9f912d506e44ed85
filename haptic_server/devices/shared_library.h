// SPDX-License-Identifier: GPL-3.0-or-later
// A maker's library, opened when it is needed: Insula builds and runs without any of them.
#pragma once
#include <memory>
#include <mutex>
#include <string>
#include <vector>

namespace insula {

class SharedLibrary {
 public:
  /// Tries the file in the environment variable `variable` (alone, where it is set), else each name in turn.
  SharedLibrary(const char* variable, const std::vector<std::string>& names);
  /// Never unloaded: makers' libraries leave threads and exit handlers behind.
  ~SharedLibrary() = default;
  SharedLibrary(const SharedLibrary&) = delete;
  SharedLibrary& operator=(const SharedLibrary&) = delete;

  bool loaded() const { return handle_ != nullptr; }
  const std::string& name() const { return name_; }
  /// Why it was not loaded, or which function was missing.
  const std::string& error() const { return error_; }

  /// Finds a function. Where there is none, the library counts as not loaded from then on; `required` false forgives
  /// that.
  template <class Function>
  void find(Function*& function, const char* symbol, bool required = true) {
    function = reinterpret_cast<Function*>(address(symbol, required));
  }

 private:
  void* address(const char* symbol, bool required);

  void* handle_ = nullptr;
  std::string name_, error_;
};

/// One for all who use it at a time: made by the first, gone with the last.
template <class T>
std::shared_ptr<T> shared_while_used() {
  static std::mutex mutex;
  static std::weak_ptr<T> known;
  std::lock_guard lock(mutex);
  std::shared_ptr<T> one = known.lock();
  if (!one) known = one = std::make_shared<T>();
  return one;
}

}  // namespace insula
