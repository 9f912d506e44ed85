// SPDX-License-Identifier: GPL-3.0-or-later
// The moment, as curricula are evaluated at it.
#pragma once
#include <chrono>
#include <cstdint>

namespace insula::training {

struct LocalTime {
  std::int64_t ms = 0;            ///< UTC, since 1970-01-01
  std::chrono::minutes offset{};  ///< of local time
};

LocalTime local_time();

}  // namespace insula::training
