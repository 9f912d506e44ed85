// SPDX-License-Identifier: GPL-3.0-or-later
// Signals arrive in the pipe, whichever thread they hit, and the old handlers come back.
#include "core/base/signal_pipe.h"

#include <gtest/gtest.h>
#include <signal.h>

#include <stdexcept>
#include <thread>

namespace insula {
namespace {

TEST(SignalPipe, TakesSignalsOfTheProcessAndOfThreads) {
  struct sigaction before {
  }, after{};
  sigaction(SIGUSR1, nullptr, &before);
  {
    const SignalPipe pipe{SIGUSR1, SIGUSR2};
    EXPECT_EQ(pipe.next(), 0);
    EXPECT_EQ(pipe.wait(0), 0);
    raise(SIGUSR1);
    std::thread([] { pthread_kill(pthread_self(), SIGUSR2); }).join();
    EXPECT_EQ(pipe.wait(-1), SIGUSR1);
    EXPECT_EQ(pipe.wait(-1), SIGUSR2);
    EXPECT_EQ(pipe.next(), 0);
    EXPECT_THROW(SignalPipe{SIGUSR1}, std::logic_error);
  }
  sigaction(SIGUSR1, nullptr, &after);
  EXPECT_EQ(after.sa_handler, before.sa_handler);
  const SignalPipe again{SIGUSR1};
}

}  // namespace
}  // namespace insula
