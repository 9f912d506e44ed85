// SPDX-License-Identifier: GPL-3.0-or-later
// What a PIN of a room is: six to twelve digits.
#pragma once
#include <string>
#include <string_view>

#include "core/base/system_random.h"

namespace insula {

inline constexpr std::string_view pin_digits = "0123456789";
inline constexpr std::size_t fewest_pin_digits = 6, most_pin_digits = 12;

inline bool is_pin(std::string_view text) {
  return text.size() >= fewest_pin_digits && text.size() <= most_pin_digits &&
         text.find_first_not_of(pin_digits) == text.npos;
}

/// A random one. other: which it must not be.
inline std::string new_pin(std::string_view other = {}) {
  std::string pin;
  do pin = system_random(fewest_pin_digits, std::string(pin_digits));
  while (pin == other);
  return pin;
}

}  // namespace insula
