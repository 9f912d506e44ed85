// SPDX-License-Identifier: GPL-3.0-or-later
#include "training/progress/local_time.h"

#include <ctime>

namespace insula::training {

LocalTime local_time() {
  const std::time_t seconds = std::time(nullptr);
  std::tm local{};
  localtime_r(&seconds, &local);
  return {1000 * std::int64_t(seconds), std::chrono::minutes(local.tm_gmtoff / 60)};
}

}  // namespace insula::training
