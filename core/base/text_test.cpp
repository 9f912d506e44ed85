// SPDX-License-Identifier: GPL-3.0-or-later
// Text helpers: cutting, quoting, UTF-8, hash.
#include "core/base/text.h"

#include <gtest/gtest.h>

namespace insula {
namespace {

TEST(Text, TrimAndSplit) {
  EXPECT_EQ(trim(" \t a b \r\n"), "a b");
  EXPECT_EQ(trim("   "), "");
  EXPECT_EQ(split_blanks("  a  bc\td ").size(), 3u);
  EXPECT_TRUE(split_blanks(" \n").empty());
}

TEST(Text, ShownIsShortCleanAndWhole) {
  EXPECT_EQ(shown("a\nb\x01"), "a?b?");
  EXPECT_LE(shown(std::string(1000, 'x')).size(), 80u);
  std::string umlauts;
  for (int i = 0; i < 100; ++i) umlauts += "\xC3\xA4";
  EXPECT_EQ(find_invalid_utf8(shown(umlauts)), std::string::npos);
}

TEST(Text, Articles) {
  EXPECT_EQ(with_article("body"), "a body");
  EXPECT_EQ(with_article("obstacle"), "an obstacle");
}

TEST(Utf8, AcceptsWellFormed) {
  for (const char* good :
       {"", "plain", "\xC3\xA4", "\xE2\x82\xAC", "\xF0\x9F\xA7\xA0", "\xED\x9F\xBF", "\xF4\x8F\xBF\xBF"})
    EXPECT_EQ(find_invalid_utf8(good), std::string_view::npos) << good;
}

TEST(Utf8, FindsTheFirstBadByte) {
  EXPECT_EQ(find_invalid_utf8("ab\xE4"), 2u);    // Latin-1
  EXPECT_EQ(find_invalid_utf8("\xC3"), 0u);      // cut
  EXPECT_EQ(find_invalid_utf8("\xC0\xAF"), 0u);  // longer than needed
  EXPECT_EQ(find_invalid_utf8("\xE0\x80\xAF"), 0u);
  EXPECT_EQ(find_invalid_utf8("\xED\xA0\x80"), 0u);      // surrogate
  EXPECT_EQ(find_invalid_utf8("\xF4\x90\x80\x80"), 0u);  // beyond Unicode
  EXPECT_EQ(find_invalid_utf8("a\x80"), 1u);             // continuation alone
  EXPECT_EQ(find_invalid_utf8("\xFF\xFE"), 0u);
}

TEST(Fnv1a, KnownValues) {
  Fnv1a empty, a, pieces;
  a.add("a");
  pieces.add("foo");
  pieces.add("bar");
  EXPECT_EQ(empty.value(), 0xcbf29ce484222325ull);
  EXPECT_EQ(a.value(), 0xaf63dc4c8601ec8cull);
  EXPECT_EQ(pieces.value(), 0x85944171f73967e8ull);
}

}  // namespace
}  // namespace insula
