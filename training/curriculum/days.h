// SPDX-License-Identifier: GPL-3.0-or-later
// Calendar days of a place whose local time is a constant offset from UTC. Times in milliseconds since 1970-01-01.
#pragma once
#include <cstdint>
#include <string>

namespace insula {

inline constexpr std::int64_t day_ms = 86'400'000;
/// Times further from 1970 than this are no times of attempts, so sums of times do not overflow.
inline constexpr std::int64_t most_ms = 100'000'000 * day_ms;

/// Number of the local day since 1970-01-01. ms, offset_ms: within most_ms.
std::int64_t local_day(std::int64_t ms, std::int64_t offset_ms);
/// UTC time at which the local day begins that holds `ms`.
std::int64_t start_of_day(std::int64_t ms, std::int64_t offset_ms);
/// "2026-03-14", the local day that holds `ms`; the number of the day where a year has more than four digits.
std::string date_text(std::int64_t ms, std::int64_t offset_ms);

}  // namespace insula
