// SPDX-License-Identifier: GPL-3.0-or-later
// Strict reading of numbers and units.
#include "core/params/number.h"

#include <fmt/format.h>

#include <cmath>

#include "core/base/decimal.h"
#include "core/base/text.h"
#include "core/params/param.h"

namespace insula {
namespace {

bool is_digit(char c) { return c >= '0' && c <= '9'; }

std::string not_a_number(std::string_view text) {
  std::string message = in_quotes(text) + " is not a number";
  if (text.find(',') != std::string_view::npos) message += " (the decimal sign is a point, not a comma)";
  return message;
}

/// The value of the first `n` characters, which number_length has approved.
std::optional<double> convert(std::string_view text, std::size_t n, std::string& error) {
  std::string_view digits = text.substr(0, n);
  if (digits.front() == '+') digits.remove_prefix(1);  // read_decimal does not accept a plus sign
  double value = 0;
  const auto [end, code] = read_decimal(digits.data(), digits.data() + digits.size(), value);
  if (code == std::errc::result_out_of_range) {
    error = in_quotes(text.substr(0, n)) + " is too large or too small a number";
    return std::nullopt;
  }
  if (code != std::errc() || end != digits.data() + digits.size() || !std::isfinite(value)) {
    error = not_a_number(text);
    return std::nullopt;
  }
  return value;
}

/// "N  m" -> "N m".
std::string single_blanks(std::string_view text) {
  std::string out;
  for (std::string_view word : split_blanks(text)) {
    if (!out.empty()) out += ' ';
    out += word;
  }
  return out;
}

const Unit* find_unit(std::span<const Unit> units, std::string_view symbol) {
  for (const auto& u : units)
    if (u.symbol == symbol) return &u;
  return nullptr;
}

}  // namespace

std::string unit_list(std::span<const Unit> units) {
  std::string out;
  for (const auto& u : units) {
    if (!u.listed) continue;
    if (!out.empty()) out += ", ";
    out += u.symbol;
  }
  return out;
}

std::string written(double si, const Unit* unit) {
  const double value = unit ? si / unit->to_si : si;
  // Six digits hide the rounding of the factor. Large whole numbers are written without an exponent.
  const bool whole = std::abs(value) >= 1e5 && std::abs(value) < 1e15;
  std::string text = whole ? fmt::format("{:.0f}", value) : fmt::format("{:.6g}", value);
  if (unit) text += " " + std::string(unit->symbol);
  return text;
}

std::size_t number_length(std::string_view text) {
  std::size_t i = 0;
  const auto digits = [&] {
    const std::size_t begin = i;
    while (i < text.size() && is_digit(text[i])) ++i;
    return i - begin;
  };
  if (i < text.size() && (text[i] == '+' || text[i] == '-')) ++i;
  std::size_t count = digits();
  if (i < text.size() && text[i] == '.') {
    ++i;
    count += digits();
  }
  if (count == 0) return 0;
  if (i < text.size() && (text[i] == 'e' || text[i] == 'E')) {
    const std::size_t before = i++;
    if (i < text.size() && (text[i] == '+' || text[i] == '-')) ++i;
    if (digits() == 0) i = before;
  }
  return i;
}

std::optional<double> read_number(std::string_view text, std::string& error) {
  text = trim(text);
  if (text.empty()) {
    error = "the value is empty";
    return std::nullopt;
  }
  const std::size_t n = number_length(text);
  if (n != text.size()) {
    error = not_a_number(text);
    return std::nullopt;
  }
  return convert(text, n, error);
}

std::optional<ParsedQuantity> read_quantity(std::string_view text, std::span<const Unit> units,
                                            std::string_view quantity, std::string& error) {
  text = trim(text);
  if (text.empty()) {
    error = "the value is empty";
    return std::nullopt;
  }
  const std::size_t n = number_length(text);
  if (n == 0) {
    error = not_a_number(text);
    return std::nullopt;
  }
  const std::string_view tail = text.substr(n);
  const std::string symbol = single_blanks(tail);
  const Unit* unit = find_unit(units, symbol);
  if (!symbol.empty() && !unit) {
    // Text that touches the digits may be a mistyped number ("12O0", "0,5", "0x1p3", "1.2.3") rather than a unit.
    std::string_view touching = tail.substr(0, tail.find_first_of(" \t\r\n"));
    const bool has_digit = touching.find_first_of("0123456789,.") != std::string_view::npos;
    const bool known = is_known_unit(symbol) || is_known_unit(touching);
    const bool unit_comes_later = !touching.empty() && touching.size() < tail.size() && !is_known_unit(symbol);
    if (!touching.empty() && !known && (has_digit || unit_comes_later)) {
      error = not_a_number(text.substr(0, n + touching.size()));
    } else if (units.empty()) {
      error = in_quotes(symbol) + " may not stand here: the value is a plain number without a unit";
    } else {
      error =
          in_quotes(symbol) + " is not a unit of " + std::string(quantity) + " (use one of " + unit_list(units) + ")";
    }
    return std::nullopt;
  }
  if (!unit && !units.empty()) {
    error = in_quotes(text) + " has no unit; " + with_article(quantity) + " needs one of " + unit_list(units);
    return std::nullopt;
  }
  const auto value = convert(text, n, error);
  if (!value) return std::nullopt;
  const double si = *value * (unit ? unit->to_si : 1.0);
  if (!std::isfinite(si)) {
    error = in_quotes(text) + " is too large or too small a number";
    return std::nullopt;
  }
  return ParsedQuantity{si, unit};
}

std::optional<Vec3> read_vector(std::string_view text, std::span<const Unit> units, std::string_view quantity,
                                const Unit*& unit, std::string& error) {
  text = trim(text);
  const auto words = split_blanks(text);
  const std::string wanted =
      units.empty() ? "three plain numbers, as in \"0 0 1\""
                    : "three numbers and one unit, as in \"1 0 -1 " + std::string(units.front().symbol) + "\"";
  if (words.size() < 3) {
    error = text.empty() ? "the value is empty; it needs " + wanted : in_quotes(text) + " needs " + wanted;
    return std::nullopt;
  }
  Vec3 value;
  for (int i = 0; i < 2; ++i) {
    const auto number = read_number(words[static_cast<std::size_t>(i)], error);
    if (!number) {
      error += "; the value needs " + wanted;
      return std::nullopt;
    }
    value[i] = *number;
  }
  const auto begin = static_cast<std::size_t>(words[2].data() - text.data());
  const auto last = read_quantity(text.substr(begin), units, quantity, error);
  if (!last) return std::nullopt;
  unit = last->unit;
  const double factor = unit ? unit->to_si : 1.0;
  value = Vec3(value[0] * factor, value[1] * factor, last->si);
  if (!value.allFinite()) {
    error = in_quotes(text) + " has too large a number";
    return std::nullopt;
  }
  return value;
}

std::optional<double> parse_quantity(std::string_view text, std::span<const Unit> units, std::string_view quantity_name,
                                     std::string& error) {
  const auto parsed = read_quantity(text, units, quantity_name, error);
  if (!parsed) return std::nullopt;
  return parsed->si;
}

}  // namespace insula
