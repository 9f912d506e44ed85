// SPDX-License-Identifier: GPL-3.0-or-later
#include "training/store/records.h"

#include <fmt/format.h>

#include <algorithm>

#include "core/base/input_error.h"
#include "core/base/text.h"

namespace insula::training {
namespace {

constexpr std::size_t longest_pseudonym = 40;
constexpr int last_year = 60;

std::size_t characters(std::string_view utf8) {
  return std::size_t(std::count_if(utf8.begin(), utf8.end(), [](char c) { return (c & 0xC0) != 0x80; }));
}

template <std::size_t N>
void check_name(std::string_view what, std::string_view value, const std::array<std::string_view, N>& names) {
  if (std::find(names.begin(), names.end(), value) != names.end()) return;
  std::vector<std::string> known(names.begin(), names.end());
  throw InputError(fmt::format("the {} is {}; it is one of: {}", what, in_quotes(value), joined(known)));
}

}  // namespace

void check(const Person& p) {
  if (p.pseudonym.empty()) throw InputError("a person needs a pseudonym");
  if (find_invalid_utf8(p.pseudonym) != std::string_view::npos) throw InputError("the pseudonym is not UTF-8");
  if (characters(p.pseudonym) > longest_pseudonym)
    throw InputError(fmt::format("the pseudonym has more than {} characters", longest_pseudonym));
  const auto control = [](char c) { return static_cast<unsigned char>(c) < 0x20 || c == 0x7f; };
  if (std::any_of(p.pseudonym.begin(), p.pseudonym.end(), control) || trim(p.pseudonym) != p.pseudonym)
    throw InputError("the pseudonym has a blank at an end or a control character");
  check_name("role", p.role, roles);
  check_name("handedness", p.handedness, handedness_names);
  if (p.year < 0 || p.year > last_year)
    throw InputError(
        fmt::format("the year of training is {}; it is 1 to {}, or 0 if it is not said", p.year, last_year));
}

}  // namespace insula::training
