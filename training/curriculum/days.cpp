// SPDX-License-Identifier: GPL-3.0-or-later
#include "training/curriculum/days.h"

#include <fmt/format.h>

#include <chrono>

namespace insula {

std::int64_t local_day(std::int64_t ms, std::int64_t offset_ms) {
  const std::int64_t local = ms + offset_ms;
  return local / day_ms - (local % day_ms < 0 ? 1 : 0);
}

std::int64_t start_of_day(std::int64_t ms, std::int64_t offset_ms) {
  return local_day(ms, offset_ms) * day_ms - offset_ms;
}

std::string date_text(std::int64_t ms, std::int64_t offset_ms) {
  const std::int64_t day = local_day(ms, offset_ms);
  if (day < -700'000 || day > 2'900'000) return fmt::format("day {}", day);
  const std::chrono::year_month_day date{std::chrono::sys_days{std::chrono::days{day}}};
  return fmt::format("{:04}-{:02}-{:02}", int(date.year()), unsigned(date.month()), unsigned(date.day()));
}

}  // namespace insula
