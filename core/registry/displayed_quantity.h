// SPDX-License-Identifier: GPL-3.0-or-later
// A quantity, and the unit and decimals in which people see its values. Channels and metrics are shown by it.
#pragma once
#include <span>
#include <string>
#include <string_view>

#include "core/params/quantity.h"

namespace insula {

class DisplayedQuantity {
 public:
  struct Quantity {
    std::string_view name, si;
    std::span<const Unit> units;
  };
  template <class Q>
  static Quantity quantity_of() {
    return {Q::name, Q::si, Q::units()};
  }

  /// unit: one of the quantity's; "%" for a plain number; empty: SI. Throws std::logic_error for another one.
  DisplayedQuantity(Quantity quantity, std::string_view unit, int digits);

  const Quantity& quantity() const { return quantity_; }
  std::string_view unit() const { return unit_.empty() ? quantity_.si : unit_; }  ///< may be empty
  double scale() const { return scale_; }                                         ///< shown number = SI value * scale
  int digits() const { return digits_; }
  /// A value as it is shown, with its unit. An unknown one is "unknown", and zero has no sign.
  std::string text(double si) const;

 private:
  Quantity quantity_;
  std::string_view unit_;
  int digits_;
  double scale_ = 1;
};

}  // namespace insula
