// SPDX-License-Identifier: GPL-3.0-or-later
// Signals as bytes in a pipe, for programs that wait on descriptors. The implementation belongs to the operating system
// (platform/).
#pragma once
#include <csignal>
#include <initializer_list>
#include <memory>

namespace insula {

/// While an object exists, the given signals are written into its pipe and have no other effect. Unlike a blocked
/// signal with sigwait or signalfd, this does not depend on the masks of threads that libraries start while loading.
/// Only one may exist per process, since signal handlers belong to the process. A second one throws std::logic_error.
class SignalPipe {
 public:
  explicit SignalPipe(std::initializer_list<int> signals);
  ~SignalPipe();
  SignalPipe(const SignalPipe&) = delete;
  SignalPipe& operator=(const SignalPipe&) = delete;

  int descriptor() const { return ends_[0]; }  ///< readable when a signal has arrived
  /// The next signal that has arrived; 0: none. Never waits.
  int next() const;
  /// Waits for a signal, at most timeout_ms (-1: without limit); 0: none came.
  int wait(int timeout_ms) const;

 private:
  struct Before;  // the handlers that were there

  int ends_[2] = {-1, -1};
  std::unique_ptr<Before> before_;
};

}  // namespace insula
