// SPDX-License-Identifier: GPL-3.0-or-later
// The self-pipe behind SignalPipe.
#include "core/base/signal_pipe.h"

#include <fcntl.h>
#include <poll.h>
#include <signal.h>
#include <unistd.h>

#include <atomic>
#include <cerrno>
#include <stdexcept>
#include <system_error>
#include <utility>
#include <vector>

namespace insula {
namespace {

std::atomic<int> write_end{-1};  // the signal handler has no other access to the pipe
static_assert(std::atomic<int>::is_always_lock_free);

void on_signal(int signal) {
  const int before = errno;
  const auto byte = static_cast<unsigned char>(signal);
  [[maybe_unused]] const auto written = write(write_end.load(), &byte, 1);  // if it is full, enough signals are waiting
  errno = before;
}

}  // namespace

struct SignalPipe::Before {
  std::vector<std::pair<int, struct sigaction>> handlers;
};

SignalPipe::SignalPipe(std::initializer_list<int> signals) : before_(std::make_unique<Before>()) {
  if (write_end.load() >= 0) throw std::logic_error("a second SignalPipe");
  if (pipe2(ends_, O_CLOEXEC | O_NONBLOCK) != 0) throw std::system_error(errno, std::generic_category(), "pipe");
  write_end = ends_[1];
  for (int signal : signals) {
    struct sigaction action {
    }, previous{};
    action.sa_handler = on_signal;
    action.sa_flags = SA_RESTART;
    sigaction(signal, &action, &previous);
    before_->handlers.emplace_back(signal, previous);
  }
}

SignalPipe::~SignalPipe() {
  for (const auto& [signal, previous] : before_->handlers) sigaction(signal, &previous, nullptr);
  write_end = -1;
  close(ends_[0]);
  close(ends_[1]);
}

int SignalPipe::next() const {
  unsigned char byte = 0;
  return read(ends_[0], &byte, 1) == 1 ? byte : 0;
}

int SignalPipe::wait(int timeout_ms) const {
  pollfd wait{ends_[0], POLLIN, 0};
  int left;
  do left = ::poll(&wait, 1, timeout_ms);
  while (left < 0 && errno == EINTR && timeout_ms < 0);
  return next();
}

}  // namespace insula
