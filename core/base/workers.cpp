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
  ++round_;
  round_.notify_all();
  for (std::thread& t : threads_) t.join();
}

void Workers::work() {
  for (;;) {
    const int i = next_.fetch_add(1);
    if (i >= count_) return;
    call_(task_, i);
  }
}

void Workers::run_raw(int count, Call call, void* task) {
  if (threads_.empty() || count < 2) {
    for (int i = 0; i < count; ++i) call(task, i);
    return;
  }
  count_ = count;
  call_ = call;
  task_ = task;
  next_ = 0;
  busy_ = int(threads_.size());
  ++round_;
  round_.notify_all();
  work();
  // The others are in their last piece or waking up in vain; both are short.
  for (int left = busy_; left != 0; left = busy_) busy_.wait(left);
}

void Workers::loop() {
  std::uint64_t seen = 0;
  for (;;) {
    round_.wait(seen);
    seen = round_;
    if (stop_) return;
    work();
    if (busy_.fetch_sub(1) == 1) busy_.notify_all();
  }
}

}  // namespace insula
