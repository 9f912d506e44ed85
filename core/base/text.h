// SPDX-License-Identifier: GPL-3.0-or-later
// Small text helpers of the readers and their messages.
#pragma once
#include <string>
#include <string_view>
#include <vector>

namespace insula {

/// Blank, tab and line ends as XML knows them.
inline bool is_blank(char c) { return c == ' ' || c == '\t' || c == '\n' || c == '\r'; }
std::string_view trim(std::string_view text);
/// The words between blanks.
std::vector<std::string_view> split_blanks(std::string_view text);
/// `text` for a message: control characters are replaced, and it is cut to at most 80 bytes at a character's border.
std::string shown(std::string_view text);
/// shown(text) in double quotes.
std::string in_quotes(std::string_view text);
/// "a body", "an obstacle".
std::string with_article(std::string_view noun);
/// "a, b, c".
std::string joined(const std::vector<std::string>& items, std::string_view separator = ", ");
/// Offset of the first byte that is not part of well-formed UTF-8 (RFC 3629), or npos.
std::size_t find_invalid_utf8(std::string_view text);

/// 64-bit FNV-1a hash (Fowler, Noll, Vo), which can be fed piece by piece.
class Fnv1a {
 public:
  void add(std::string_view bytes) {
    for (unsigned char c : bytes) hash_ = (hash_ ^ c) * 1099511628211ull;
  }
  unsigned long long value() const { return hash_; }

 private:
  unsigned long long hash_ = 14695981039346656037ull;
};

}  // namespace insula
