// SPDX-License-Identifier: GPL-3.0-or-later
// Threads that sleep between loops.
#include "core/base/workers.h"

#include <algorithm>

namespace insula {

Workers::Workers(int threads) {
  if (threads <= 0) threads = std::clamp(int(std::thread::hardware_concurrency()), 1, 8);
  for (int i = 1; i < threads; ++i) threads_.emplace_back([this] { loop(); });
}

Workers::~Workers() {
  stop_ = true;
  ticket_ += std::uint64_t(1) << 32;
  ticket_.notify_all();
  for (std::thread& t : threads_) t.join();
}

// Takes indices of the ticket's loop until none is left. A taken index keeps the loop open, so call_ and task_ stay
// valid. Indices of a loop that has ended, or is being set up, cannot be taken.
void Workers::work(std::uint64_t ticket) {
  const std::uint64_t round = ticket >> 32;
  for (;;) {
    const int count = count_;
    if (ticket >> 32 != round || int(ticket & closed) >= count || (ticket & closed) == closed) return;
    if (!ticket_.compare_exchange_strong(ticket, ticket + 1)) continue;
    call_(task_, int(ticket & closed));
    if (done_.fetch_add(1) + 1 == count) done_.notify_all();
    ticket = ticket_;
  }
}

void Workers::run_raw(int count, Call call, void* task) {
  if (threads_.empty() || count < 2) {
    for (int i = 0; i < count; ++i) call(task, i);
    return;
  }
  const std::uint64_t round = (ticket_ >> 32) + 1;
  ticket_ = (round << 32) | closed;  // late threads of the last loop find it closed before anything changes
  count_ = count;
  done_ = 0;
  call_ = call;
  task_ = task;
  ticket_ = round << 32;
  ticket_.notify_all();
  work(round << 32);
  for (int d = done_; d != count; d = done_) done_.wait(d);
}

void Workers::loop() {
  std::uint64_t seen = ticket_;
  while (!stop_) {
    work(seen);
    const std::uint64_t now = ticket_;
    if (now >> 32 == seen >> 32 && (now & closed) != 0) ticket_.wait(now);  // wakes for the next loop
    seen = ticket_;
  }
}

}  // namespace insula
