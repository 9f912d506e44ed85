// SPDX-License-Identifier: GPL-3.0-or-later
// How cases may be called.
#pragma once
#include <algorithm>
#include <string_view>

namespace insula {

inline bool is_case_letter(char c) {
  return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '_' || c == '-';
}

/// Letters, digits, _ and -, at most 64.
inline bool is_case_name(std::string_view name) {
  return !name.empty() && name.size() <= 64 && std::all_of(name.begin(), name.end(), is_case_letter);
}

}  // namespace insula
