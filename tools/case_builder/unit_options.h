// SPDX-License-Identifier: GPL-3.0-or-later
// Values of the command line with units, as in scenes: "0.4 mm", "30 deg", "30 -20 55 mm". For a number without a unit,
// the error message says which unit to write.
#pragma once
#include <array>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "core/params/option.h"
#include "core/params/quantity.h"

namespace insula::case_builder {

/// Reads a value and converts it to the unit `option.bare`. Empty, with the reason in `error`, if the text has no unit
/// or is out of range.
std::optional<double> read_with_unit(std::string_view text, std::span<const Unit> units, std::string_view quantity,
                                     const QuantityOption& option, std::string& error);

/// Contents of a text with positions and directions, in this order.
enum class Shape { point, plane, two_points, motion };
/// The number of numbers in a shape.
constexpr std::size_t number_count(Shape shape) { return shape == Shape::point ? 3 : 6; }
/// The pattern for the user: "X Y Z mm" for a position, NX NY NZ for a direction, RX RY RZ deg for a rotation (its axis
/// times its angle).
std::string_view pattern(Shape shape);

/// Reads the numbers of a point, a plane (a point and a direction), two points or a motion (a shift and a rotation),
/// lengths in mm and angles in degrees. Empty, with the reason
/// in `error`, if the text does not follow the pattern.
std::optional<std::vector<double>> read_shape(std::string_view text, Shape shape, std::string& error);

/// Reads the unit of a file, in mm: a unit's name ("m", "inch") or a length ("0.35 mm").
std::optional<double> read_file_unit(std::string_view text, std::string& error);

/// The words of the command line, in which the words of each value of `options` are joined: --seed 30 -20 55 mm becomes
/// --seed "30 -20 55 mm".
std::vector<std::string> joined_values(const std::vector<std::string>& words, const std::vector<std::string>& options);

}  // namespace insula::case_builder
