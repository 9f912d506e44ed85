// SPDX-License-Identifier: GPL-3.0-or-later
// Command-line options with units, read as a scene's values: --duration 5s, --rate "100 Hz".
//
//   double duration = 0;
//   add_quantity<Duration>(app, "--duration", duration, {.bare = "s", .min = "0 s", .doc = "simulated time"});
//
// A bare number has the unit `bare`. The stored value has this unit too.
#pragma once
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "core/params/quantity.h"

namespace insula {

struct QuantityOption {
  std::string_view bare;      ///< unit of the stored value and of a number without a unit; one of the quantity's
  std::string_view min = {};  ///< smallest value with its unit; empty: none
  std::string_view max = {};  ///< largest value with its unit; empty: none
  std::string doc;            ///< one line for --help
};

/// The value of an option's text in the unit `option.bare`. Returns nothing, with the reason in `error`, if the text is
/// not such a quantity or is out of range. Throws std::logic_error if the unit or range of the declaration is invalid.
std::optional<double> read_option(std::string_view text, std::span<const Unit> units, std::string_view quantity,
                                  const QuantityOption& option, std::string& error);

/// Text of --help for an option with a unit: its doc and the unit of a bare number.
std::string option_doc(const QuantityOption& option);

/// The words of a command line after the program's name. A separate word that is the unit of an option's number is
/// joined to it: `--rate 100 Hz` is `--rate "100 Hz"`.
std::vector<std::string> command_words(int argc, const char* const* argv);

/// Error text if a whole number is below `least`; empty otherwise. For CLI11's check().
std::string below(std::string_view text, int least);

/// Adds an option with a unit to a CLI::App (a template, so that this header does not need CLI11). Returns the
/// CLI::Option.
template <class Q, class App>
auto* add_quantity(App& app, const std::string& name, double& value, const QuantityOption& option) {
  const auto check = [option](const std::string& text) {
    std::string error;
    read_option(text, Q::units(), Q::name, option, error);
    return error;
  };
  const auto take = [&value, option](const std::string& text) {
    std::string error;
    if (const auto read = read_option(text, Q::units(), Q::name, option, error)) value = *read;
  };
  return app.template add_option_function<std::string>(name, take, option_doc(option))
      ->type_name("QUANTITY")
      ->check(check);
}

/// The same for several values with commas between them.
template <class Q, class App>
auto* add_quantities(App& app, const std::string& name, std::vector<double>& values, const QuantityOption& option) {
  const auto check = [option](const std::string& text) {
    std::string error;
    read_option(text, Q::units(), Q::name, option, error);
    return error;
  };
  const auto take = [&values, option](const std::vector<std::string>& texts) {
    values.clear();
    std::string error;
    for (const std::string& text : texts)
      values.push_back(read_option(text, Q::units(), Q::name, option, error).value());
  };
  return app.template add_option_function<std::vector<std::string>>(name, take, option_doc(option))
      ->delimiter(',')
      ->type_name("QUANTITY,...")
      ->check(check);
}

}  // namespace insula
