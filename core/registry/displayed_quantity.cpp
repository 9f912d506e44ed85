// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/registry/displayed_quantity.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <stdexcept>

namespace insula {

DisplayedQuantity::DisplayedQuantity(Quantity quantity, std::string_view unit, int digits)
    : quantity_(quantity), digits_(digits) {
  if (unit == "%" && quantity.units.empty()) {
    unit_ = "%";
    scale_ = 100;
  } else if (!unit.empty()) {
    const auto known =
        std::find_if(quantity.units.begin(), quantity.units.end(), [&](const Unit& u) { return u.symbol == unit; });
    if (known == quantity.units.end())
      throw std::logic_error("\"" + std::string(unit) + "\" is no unit of " + std::string(quantity.name));
    unit_ = known->symbol;
    scale_ = 1 / known->to_si;
  }
}

std::string DisplayedQuantity::text(double si) const {
  if (!std::isfinite(si)) return "unknown";
  char number[64];
  std::snprintf(number, sizeof number, "%.*f", digits_, si * scale_);
  std::string out = number;
  if (out.find_first_not_of("-0.") == std::string::npos && out.front() == '-') out.erase(0, 1);
  return unit().empty() ? out : out + " " + std::string(unit());
}

}  // namespace insula
