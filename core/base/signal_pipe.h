// SPDX-License-Identifier: GPL-3.0-or-later
// Signals as bytes in a pipe, for programs that wait on descriptors.
#pragma once
#include <initializer_list>
#include <utility>
#include <vector>

#include <signal.h>

namespace insula {

/// While it lives, the given signals end up in its pipe instead of doing what they did before. Unlike a blocked signal with
/// sigwait or signalfd this does not depend on the masks of threads that libraries start on their own while loading.
/// One per process at a time (signal handlers belong to the process): a second one throws std::logic_error.
class SignalPipe {
 public:
  explicit SignalPipe(std::initializer_list<int> signals);
  ~SignalPipe();
  SignalPipe(const SignalPipe&) = delete;
  SignalPipe& operator=(const SignalPipe&) = delete;

  int descriptor() const { return ends_[0]; }  ///< readable when a signal has come
  /// The next signal that has come; 0: none. Never waits.
  int next() const;
  /// Waits for a signal, at most timeout_ms (-1: without limit); 0: none came.
  int wait(int timeout_ms) const;

 private:
  int ends_[2] = {-1, -1};
  std::vector<std::pair<int, struct sigaction>> before_;
};

}  // namespace insula
