// SPDX-License-Identifier: GPL-3.0-or-later
// Periods of a training programme: from hours to weeks. Times within an exercise have seconds instead
// (core/params/quantity.h).
#pragma once
#include "core/params/quantity.h"

namespace insula {

struct Period {
  static constexpr std::string_view name = "period";
  static constexpr std::string_view si = "s";
  static std::span<const Unit> units();  ///< day week h min
};

}  // namespace insula
