// SPDX-License-Identifier: GPL-3.0-or-later
// read_decimal() for standard libraries that cannot read a double, by the library fast_float.
#pragma once
#include <fast_float/fast_float.h>

#include <algorithm>
#include <charconv>
#include <cmath>

namespace insula {

/// As std::from_chars: out of range is reported, and the value is then left as it was. Versions of fast_float differ in
/// this.
inline std::from_chars_result read_decimal_by_fast_float(const char* first, const char* last, double& value) {
  double read = 0;
  const auto [end, code] = fast_float::from_chars(first, last, read);
  if (code != std::errc() && code != std::errc::result_out_of_range) return {first, code};
  const char* digits = first != end && *first == '-' ? first + 1 : first;
  const bool spelled_out = digits != end && (*digits < '0' || *digits > '9') && *digits != '.';  // inf, nan
  const char* exponent = std::find_if(digits, end, [](char c) { return c == 'e' || c == 'E'; });
  const bool zero = std::none_of(digits, exponent, [](char c) { return c >= '1' && c <= '9'; });
  if (!spelled_out && (std::isinf(read) || (read == 0 && !zero))) return {end, std::errc::result_out_of_range};
  value = read;
  return {end, std::errc()};
}

}  // namespace insula
