// SPDX-License-Identifier: GPL-3.0-or-later
// Reads lists of numbers. Each number is read and checked as the value of a parameter of its own.
#include "core/params/list.h"

#include "core/base/text.h"
#include "core/params/number.h"

namespace insula {
namespace {

constexpr std::size_t most_numbers = 1000;

std::string too_many(std::size_t count) {
  return "lists " + std::to_string(count) + " numbers; at most " + std::to_string(most_numbers) + " are allowed";
}

}  // namespace

QuantityListParam::QuantityListParam(ParamSet* owner, ParamSpec spec, std::string_view quantity, std::string_view si,
                                     std::span<const Unit> units)
    : ParamBase(owner, std::move(spec)), quantity_(quantity), si_(si), units_(units) {}

std::string QuantityListParam::parse(std::string_view text) {
  // The unit begins with the first word that does not begin as a number.
  const auto words = split_blanks(text);
  std::size_t count = 0;
  while (count < words.size() && number_length(words[count]) > 0) ++count;
  if (count == 0) return words.empty() ? "the value is empty" : in_quotes(words.front()) + " is not a number";
  if (count > most_numbers) return too_many(count);
  std::string unit;
  for (std::size_t i = count; i < words.size(); ++i) unit += " " + std::string(words[i]);
  // "1 3 7day": the unit may touch the last number.
  const std::string_view last = words[count - 1];
  if (unit.empty()) unit = last.substr(number_length(last));
  ParamSet alone;
  QuantityParam number(&alone, {.name = "number", .min = spec().min, .max = spec().max, .doc = ""}, quantity_, si_,
                       units_);
  std::vector<double> values;
  for (std::size_t i = 0; i < count; ++i) {
    const bool has_unit = i + 1 == count && number_length(last) < last.size();
    const std::string one = std::string(words[i]) + (has_unit ? "" : unit);
    if (const std::string error = number.assign(one, {}); !error.empty()) return error;
    values.push_back(number());
  }
  values_ = std::move(values);
  return {};
}

std::string Param<List<int>>::parse(std::string_view text) {
  const auto words = split_blanks(text);
  if (words.empty()) return "the value is empty";
  if (words.size() > most_numbers) return too_many(words.size());
  ParamSet alone;
  Param<int> number(&alone, {.name = "number", .min = spec().min, .max = spec().max, .doc = ""});
  std::vector<int> values;
  for (const std::string_view word : words) {
    if (const std::string error = number.assign(word, {}); !error.empty()) return error;
    values.push_back(number());
  }
  values_ = std::move(values);
  return {};
}

}  // namespace insula
