// SPDX-License-Identifier: GPL-3.0-or-later
// How long a sender waits after a failure.
#pragma once
#include <algorithm>
#include <cstdint>
#include <random>

namespace insula::xapi {

inline constexpr std::int64_t first_wait_ms = 2000, longest_wait_ms = 600'000;

/// After the n-th failure in a row: first_wait_ms, doubled each time up to longest_wait_ms. Between half of it and all
/// of it is drawn at random, so that many senders do not come back in the same moment.
inline std::int64_t backoff_ms(int failures, std::mt19937_64& random) {
  std::int64_t wait = first_wait_ms;
  for (int k = 1; k < failures && wait < longest_wait_ms; ++k) wait *= 2;
  wait = std::min(wait, longest_wait_ms);
  return std::uniform_int_distribution<std::int64_t>(wait / 2, wait)(random);
}

}  // namespace insula::xapi
