// SPDX-License-Identifier: GPL-3.0-or-later
// Strict reading of numbers and units: the whole text must be valid, and the result is the same under every locale.
#pragma once
#include <optional>
#include <span>
#include <string>
#include <string_view>

#include "core/base/math.h"
#include "core/params/quantity.h"

namespace insula {

struct ParsedQuantity {
  double si = 0;
  const Unit* unit = nullptr;  ///< as the author wrote it; null for a dimensionless number
};

/// Length of the decimal number ([+-] digits [. digits] [e [+-] digits]) at the front of `text`; 0 when there is none.
std::size_t number_length(std::string_view text);
/// The value of a text that is one decimal number and nothing else. Otherwise writes the error text, which starts with
/// the quoted text, to `error`.
std::optional<double> read_number(std::string_view text, std::string& error);
/// Reads "12.5 kPa", or "12.5" without units.
std::optional<ParsedQuantity> read_quantity(std::string_view text, std::span<const Unit> units,
                                            std::string_view quantity, std::string& error);
/// Reads "38 0 -15 mm", or "0 0 1" without units.
std::optional<Vec3> read_vector(std::string_view text, std::span<const Unit> units, std::string_view quantity,
                                const Unit*& unit, std::string& error);
/// A value as an author would write it: six significant digits and the unit.
std::string written(double si, const Unit* unit);
/// "Pa, kPa, MPa, mmHg".
std::string unit_list(std::span<const Unit> units);

}  // namespace insula
