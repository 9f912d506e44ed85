// SPDX-License-Identifier: GPL-3.0-or-later
// Values of the command line with their units, as scenes have them: "0.4 mm", "30 deg", "30 -20 55 mm". A number
// without a unit is an error that says which unit to write.
#pragma once
#include <array>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "core/params/option.h"
#include "core/params/quantity.h"

namespace insula::case_builder {

/// A value in the unit `option.bare`. None, and the reason in `error`, when the text has no unit or is out of range.
std::optional<double> read_with_unit(std::string_view text, std::span<const Unit> units, std::string_view quantity,
                                     const QuantityOption& option, std::string& error);

/// What a text of positions and directions holds, in this order.
enum class Shape { point, plane, two_points };
/// How many numbers a shape has.
constexpr std::size_t number_count(Shape shape) { return shape == Shape::point ? 3 : 6; }
/// What to write for it: "X Y Z mm", and NX NY NZ for a direction.
std::string_view pattern(Shape shape);

/// The numbers of a point, a plane (a point and a direction) or two points; lengths in mm. None, and the reason in
/// `error`, when the text does not follow the pattern.
std::optional<std::vector<double>> read_shape(std::string_view text, Shape shape, std::string& error);

/// The millimetres that a unit of a file has: a unit's name ("m", "inch") or a length ("0.35 mm").
std::optional<double> read_file_unit(std::string_view text, std::string& error);

/// The words of the command line, with what belongs to one of `options` joined: --seed 30 -20 55 mm becomes --seed
/// "30 -20 55 mm".
std::vector<std::string> joined_values(const std::vector<std::string>& words, const std::vector<std::string>& options);

}  // namespace insula::case_builder
