// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/params/option.h"

#include <gtest/gtest.h>

#include <array>

namespace insula {
namespace {

const QuantityOption duration{.bare = "s", .min = "0 s", .doc = "simulated time"};
const QuantityOption rate{.bare = "Hz", .min = "20 Hz", .max = "1 kHz", .doc = "ticks"};

template <class Q>
std::optional<double> read(std::string_view text, const QuantityOption& option, std::string& error) {
  return read_option(text, Q::units(), Q::name, option, error);
}

TEST(Option, TakesUnitsAsScenesDo) {
  std::string error;
  EXPECT_EQ(read<Duration>("5s", duration, error), 5.0);
  EXPECT_EQ(read<Duration>(" 250 ms ", duration, error), 0.25);
  EXPECT_EQ(read<Duration>("2 min", duration, error), 120.0);
  EXPECT_EQ(read<Frequency>("1kHz", rate, error), 1000.0);
  EXPECT_EQ(error, "");
}

TEST(Option, ABareNumberIsInTheUnitOfTheOption) {
  std::string error;
  EXPECT_EQ(read<Duration>("1.5", duration, error), 1.5);
  EXPECT_EQ(read<Duration>("0", duration, error), 0.0);
  EXPECT_NEAR(*read<Length>("0.2 mm", {.bare = "mm", .doc = ""}, error), 0.2, 1e-15);
  EXPECT_NEAR(*read<Length>("3", {.bare = "mm", .doc = ""}, error), 3.0, 1e-15);
  EXPECT_EQ(option_doc(duration), "simulated time (a bare number is in s)");
}

TEST(Option, SaysWhatIsWrong) {
  std::string error;
  EXPECT_FALSE(read<Duration>("5 mm", duration, error));
  EXPECT_NE(error.find("\"mm\" is not a unit of time (use one of s, ms"), std::string::npos) << error;
  EXPECT_FALSE(read<Duration>("-1", duration, error));
  EXPECT_EQ(error, "-1 s is below the allowed minimum 0 s");
  EXPECT_FALSE(read<Frequency>("2 kHz", rate, error));
  EXPECT_EQ(error, "2 kHz is outside the allowed range 20 Hz to 1 kHz");
  EXPECT_FALSE(read<Duration>("", duration, error));
  EXPECT_FALSE(read<Duration>("5O", duration, error));
  EXPECT_FALSE(read<Duration>("1e999", duration, error));
}

TEST(Option, AUnitThatStandsAloneJoinsItsNumber) {
  const std::array words{"insula", "bench", "scene.xml", "--rate", "100", "Hz", "--steps", "5", "7", "s"};
  EXPECT_EQ(command_words(int(words.size()), words.data()),
            (std::vector<std::string>{"bench", "scene.xml", "--rate", "100 Hz", "--steps", "5", "7", "s"}));
}

TEST(Option, WholeNumbersHaveALeastOne) {
  EXPECT_EQ(below("3", 1), "");
  EXPECT_EQ(below("0", 1), "0 is below the allowed minimum 1");
  EXPECT_EQ(below("-2", 0), "-2 is below the allowed minimum 0");
  EXPECT_EQ(below("2.5", 1), "\"2.5\" is not a whole number");
}

}  // namespace
}  // namespace insula
