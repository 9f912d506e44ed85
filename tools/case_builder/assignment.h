// SPDX-License-Identifier: GPL-3.0-or-later
// "NAME=VALUE", as several options have it.
#pragma once
#include <optional>
#include <string>
#include <string_view>

#include "core/base/text.h"

namespace insula::case_builder {

struct Assignment {
  std::string name, value;
};

/// At the first sign, without the blanks around name and value; none without a sign.
inline std::optional<Assignment> read_assignment(std::string_view text) {
  const std::size_t sign = text.find('=');
  if (sign == std::string_view::npos) return std::nullopt;
  return Assignment{std::string(trim(text.substr(0, sign))), std::string(trim(text.substr(sign + 1)))};
}

}  // namespace insula::case_builder
