// SPDX-License-Identifier: GPL-3.0-or-later
// One sender for each store. The system gives the lock back when its process ends, however it ends.
#pragma once
#include <filesystem>

namespace insula::xapi {

class SenderLock {
 public:
  /// The lock is a file beside the store, NAME.sender. Throws InputError if it cannot be made.
  explicit SenderLock(const std::filesystem::path& store);
  ~SenderLock();
  SenderLock(const SenderLock&) = delete;
  SenderLock& operator=(const SenderLock&) = delete;

  /// False: another sender has it. Never waits.
  bool take() const;

 private:
  int descriptor_ = -1;
};

}  // namespace insula::xapi
