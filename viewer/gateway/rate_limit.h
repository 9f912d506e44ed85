// SPDX-License-Identifier: GPL-3.0-or-later
// At most so many in a second, with some at once.
#pragma once
#include <algorithm>
#include <chrono>

namespace insula::gateway {

class RateLimit {
 public:
  using Clock = std::chrono::steady_clock;
  RateLimit(double per_s, double at_once) : per_s_(per_s), at_once_(at_once), left_(at_once) {}

  /// Whether one more is within the limit now.
  bool take(Clock::time_point now) {
    const double seconds = std::max(0.0, std::chrono::duration<double>(now - at_).count());
    at_ = now;
    left_ = std::min(at_once_, left_ + seconds * per_s_);
    if (left_ < 1) return false;
    left_ -= 1;
    return true;
  }

 private:
  double per_s_, at_once_, left_;
  Clock::time_point at_{};
};

}  // namespace insula::gateway
