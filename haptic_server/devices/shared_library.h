// SPDX-License-Identifier: GPL-3.0-or-later
// A maker's library, opened when it is needed. Insula builds and runs without any of them.
#pragma once
#include <memory>
#include <mutex>
#include <string>
#include <vector>

namespace insula {

class SharedLibrary {
 public:
  /// Tries only the file in the environment variable `variable` if it is set, or else each name in order.
  SharedLibrary(const char* variable, const std::vector<std::string>& names);
  /// Never unloads it, since makers' libraries leave threads and exit handlers behind.
  ~SharedLibrary() = default;
  SharedLibrary(const SharedLibrary&) = delete;
  SharedLibrary& operator=(const SharedLibrary&) = delete;

  bool loaded() const { return handle_ != nullptr; }
  const std::string& name() const { return name_; }
  /// Reason why it was not loaded, or the name of a missing function.
  const std::string& error() const { return error_; }

  /// Finds a function. If a required function is missing, the library counts as not loaded from then on.
  template <class Function>
  void find(Function*& function, const char* symbol, bool required = true) {
    function = reinterpret_cast<Function*>(address(symbol, required));
  }

 private:
  void* address(const char* symbol, bool required);

  void* handle_ = nullptr;
  std::string name_, error_;
};

/// One object for all users at a time. The first creates it, and it is destroyed with the last.
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
