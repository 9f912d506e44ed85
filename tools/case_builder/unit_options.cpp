// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/case_builder/unit_options.h"

#include <algorithm>

#include "core/base/text.h"
#include "core/params/number.h"

namespace insula::case_builder {
namespace {

bool is_number(std::string_view word) { return !word.empty() && number_length(word) == word.size(); }

bool is_number_with_unit(std::string_view word) {
  const std::size_t n = number_length(word);
  return n > 0 && n < word.size() && is_known_unit(word.substr(n));
}

/// Splits a text into numbers and units, with or without blanks between them.
std::vector<std::string> parts_of(std::string_view text) {
  std::vector<std::string> out;
  while (!(text = trim(text)).empty()) {
    std::size_t n = number_length(text);
    if (n == 0) n = std::min(text.find_first_of(" \t"), text.size());
    out.emplace_back(text.substr(0, n));
    text.remove_prefix(n);
  }
  return out;
}

const Unit* unit_of(std::span<const Unit> units, std::string_view symbol) {
  for (const Unit& unit : units)
    if (unit.symbol == symbol) return &unit;
  return nullptr;
}

const Unit* length_unit(std::string_view symbol) { return unit_of(Length::units(), symbol); }

/// What three numbers are, and thereby their unit.
enum class Three { position, direction, rotation };

/// How many of the numbers' own unit, mm or degrees, the unit at the front is; the unit is removed. 0: there is none.
double take_unit(std::span<const std::string>& parts, Three what) {
  const bool turned = what == Three::rotation;
  const auto units = turned ? Angle::units() : Length::units();
  const Unit* unit = parts.empty() ? nullptr : unit_of(units, parts[0]);
  if (!unit) return 0;
  parts = parts.subspan(1);
  const Unit* own = unit_of(units, turned ? "deg" : "mm");
  return unit == own ? 1 : unit->to_si / own->to_si;
}

/// Removes three numbers from the front of the parts, and their unit unless they are a direction. False if they are
/// missing.
bool take_vector(std::span<const std::string>& parts, Three what, std::vector<double>& out) {
  if (parts.size() < 3) return false;
  std::array<double, 3> v{};
  std::string ignored;
  for (std::size_t k = 0; k < 3; ++k) {
    const auto value = read_number(parts[k], ignored);
    if (!value) return false;
    v[k] = *value;
  }
  parts = parts.subspan(3);
  const double factor = what == Three::direction ? 1 : take_unit(parts, what);
  if (factor == 0) return false;
  for (const double x : v) out.push_back(factor * x);
  return true;
}

/// The text with "mm" after each position, if it has only numbers and as many as the shape has; else empty.
std::string with_units(std::span<const std::string> parts, Shape shape) {
  if (parts.size() != number_count(shape) || !std::all_of(parts.begin(), parts.end(), is_number)) return "";
  std::string out;
  for (std::size_t k = 0; k < parts.size(); ++k) {
    out += (k ? " " : "") + parts[k];
    if (k == 2 || (k == 5 && shape == Shape::two_points)) out += " mm";
    if (k == 5 && shape == Shape::motion) out += " deg";
  }
  return out;
}

}  // namespace

std::optional<double> read_with_unit(std::string_view text, std::span<const Unit> units, std::string_view quantity,
                                     const QuantityOption& option, std::string& error) {
  if (is_number(trim(text))) {
    error =
        in_quotes(text) + " has no unit; write " + in_quotes(std::string(trim(text)) + " " + std::string(option.bare));
    return std::nullopt;
  }
  return read_option(text, units, quantity, option, error);
}

std::string_view pattern(Shape shape) {
  switch (shape) {
    case Shape::point: return "X Y Z mm";
    case Shape::plane: return "X Y Z mm NX NY NZ";
    case Shape::two_points: return "X Y Z mm X Y Z mm";
    case Shape::motion: return "X Y Z mm RX RY RZ deg";
  }
  return "";
}

std::optional<std::vector<double>> read_shape(std::string_view text, Shape shape, std::string& error) {
  const std::vector<std::string> all = parts_of(text);
  std::span<const std::string> parts(all);
  std::vector<double> out;
  const Three second = shape == Shape::two_points ? Three::position
                       : shape == Shape::motion   ? Three::rotation
                                                  : Three::direction;
  const bool read = take_vector(parts, Three::position, out) &&
                    (shape == Shape::point || take_vector(parts, second, out)) && parts.empty();
  if (read) return out;
  const std::string meant = with_units(all, shape);
  error = meant.empty() ? in_quotes(text) + " is not of the form " + in_quotes(pattern(shape))
                        : in_quotes(text) + " has no unit; write " + in_quotes(meant);
  return std::nullopt;
}

std::optional<double> read_file_unit(std::string_view text, std::string& error) {
  if (trim(text) == "inch") return 25.4;
  if (const Unit* unit = length_unit(trim(text))) return unit->symbol == "mm" ? 1 : unit->to_si / 1e-3;
  const QuantityOption option{.bare = "mm", .min = "1e-9 mm", .max = "1e9 mm", .doc = {}};
  const auto mm = read_with_unit(text, Length::units(), Length::name, option, error);
  if (!mm && number_length(trim(text)) == 0)
    error = in_quotes(text) + " is no unit; write m, cm, mm, um, inch or a length";
  return mm;
}

std::vector<std::string> joined_values(const std::vector<std::string>& words, const std::vector<std::string>& options) {
  std::vector<std::string> out;
  bool of_option = false, has_value = false;  // after one of the options; after the first word of its value
  for (const std::string& word : words) {
    const bool number_or_unit = is_number(word) || is_number_with_unit(word) || is_known_unit(word);
    if (of_option && has_value && number_or_unit) {
      out.back() += " " + word;
    } else if (of_option && !has_value) {
      has_value = true;
      out.push_back(word);
    } else {
      of_option = std::find(options.begin(), options.end(), word) != options.end();
      has_value = false;
      out.push_back(word);
    }
  }
  return out;
}

}  // namespace insula::case_builder
