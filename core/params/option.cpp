// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/params/option.h"

#include <charconv>
#include <stdexcept>

#include "core/base/text.h"
#include "core/params/number.h"

namespace insula {
namespace {

const Unit& unit_of(std::span<const Unit> units, std::string_view symbol) {
  for (const Unit& unit : units)
    if (unit.symbol == symbol) return unit;
  throw std::logic_error(in_quotes(symbol) + " is not a unit of the option's quantity");
}

std::optional<double> bound(std::string_view text, std::span<const Unit> units, std::string_view quantity) {
  if (text.empty()) return std::nullopt;
  std::string error;
  const auto read = read_quantity(text, units, quantity, error);
  if (!read) throw std::logic_error("an option's range: " + error);
  return read->si;
}

}  // namespace

std::optional<double> read_option(std::string_view text, std::span<const Unit> units, std::string_view quantity,
                                  const QuantityOption& option, std::string& error) {
  const Unit& bare = unit_of(units, option.bare);
  const auto min = bound(option.min, units, quantity), max = bound(option.max, units, quantity);
  const std::string_view given = trim(text);
  const bool has_unit = given.empty() || number_length(given) != given.size();
  const std::string whole = has_unit ? std::string(given) : std::string(given) + " " + std::string(bare.symbol);
  const auto read = read_quantity(whole, units, quantity, error);
  if (!read) return std::nullopt;
  if ((!min || read->si >= *min) && (!max || read->si <= *max)) {
    error.clear();
    return read->si / bare.to_si;
  }
  if (min && max)
    error = whole + " is outside the allowed range " + std::string(option.min) + " to " + std::string(option.max);
  else if (min) error = whole + " is below the allowed minimum " + std::string(option.min);
  else error = whole + " is above the allowed maximum " + std::string(option.max);
  return std::nullopt;
}

std::string option_doc(const QuantityOption& option) {
  return option.doc + " (a bare number is in " + std::string(option.bare) + ")";
}

std::vector<std::string> command_words(int argc, const char* const* argv) {
  std::vector<std::string> words;
  for (int k = 1; k < argc; ++k) {
    const std::string_view word = argv[k];
    const bool behind_number = words.size() >= 2 && words[words.size() - 2].starts_with("--") &&
                               !words.back().empty() && number_length(words.back()) == words.back().size();
    if (behind_number && is_known_unit(word)) words.back() += " " + std::string(word);
    else words.emplace_back(word);
  }
  return words;
}

std::string below(std::string_view text, int least) {
  int value = 0;
  const auto [end, code] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (code != std::errc() || end != text.data() + text.size()) return in_quotes(text) + " is not a whole number";
  return value < least ? std::string(text) + " is below the allowed minimum " + std::to_string(least) : std::string();
}

}  // namespace insula
