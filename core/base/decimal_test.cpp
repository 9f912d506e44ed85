// SPDX-License-Identifier: GPL-3.0-or-later
// The two ways to read a number agree to the last bit, and in what they refuse.
#include "core/base/decimal.h"

#include <gtest/gtest.h>

#if defined(__cpp_lib_to_chars) && __has_include(<fast_float/fast_float.h>)
#include <bit>
#include <cstdint>
#include <cstdio>
#include <cstring>
#include <random>
#include <string>

#include "core/base/decimal_by_fast_float.h"

namespace insula {
namespace {

void expect_same(const std::string& text) {
  double a = 7, b = 7;
  const char *first = text.data(), *last = first + text.size();
  const auto by_standard = std::from_chars(first, last, a);
  const auto by_library = read_decimal_by_fast_float(first, last, b);
  EXPECT_EQ(by_standard.ec, by_library.ec) << text;
  EXPECT_EQ(by_standard.ptr - first, by_library.ptr - first) << text;
  EXPECT_EQ(std::bit_cast<std::uint64_t>(a), std::bit_cast<std::uint64_t>(b)) << text;
}

TEST(Decimal, BothWaysAgreeOnSpecialTexts) {
  for (const char* text : {"0",
                           "-0",
                           "0e999",
                           "1",
                           "-1.5",
                           ".5",
                           "5.",
                           ".",
                           "",
                           "-",
                           "+1",
                           "e5",
                           "1e",
                           "1e+",
                           "1e5x",
                           "0,5",
                           "12O0",
                           "0x10",
                           "inf",
                           "-inf",
                           "infinity",
                           "1e400",
                           "-1e400",
                           "1e-400",
                           "4.9e-324",
                           "2e-324",
                           "1.7976931348623157e308",
                           "1.7976931348623159e308",
                           "9007199254740993",
                           "0.1000000000000000055511151231257827",
                           " 1"})
    expect_same(text);
}

TEST(Decimal, BothWaysAgreeOnRandomBits) {
  std::mt19937_64 random(5);
  for (int i = 0; i < 20000; ++i) {
    const auto x = std::bit_cast<double>(random());
    char text[40];
    std::snprintf(text, sizeof text, "%.*g", int(random() % 18) + 1, x);
    if (std::strstr(text, "nan") == nullptr) expect_same(text);
  }
}

}  // namespace
}  // namespace insula
#else
TEST(Decimal, BothWaysAgree) { GTEST_SKIP() << "one of the two ways is not installed: libfast-float-dev"; }
#endif
