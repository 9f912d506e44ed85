// SPDX-License-Identifier: GPL-3.0-or-later
// Conversion of a byte offset of a text to line and column in characters.
#pragma once
#include <string_view>

namespace insula {

/// Forward moves through the whole text cost its length once. A backward move starts again at the beginning of the
/// text.
class LineIndex {
 public:
  explicit LineIndex(std::string_view text) : text_(text) {}

  /// Moves to the offset (clamped to the text); line() and column() then count from 1.
  void seek(std::size_t offset) {
    if (offset > text_.size()) offset = text_.size();
    if (offset < at_) {
      at_ = 0;
      line_ = column_ = 1;
    }
    for (; at_ < offset; ++at_) {
      const char c = text_[at_];
      const bool lone_return = c == '\r' && (at_ + 1 >= text_.size() || text_[at_ + 1] != '\n');
      if (c == '\n' || lone_return) {
        ++line_;
        column_ = 1;
      } else if (c != '\r' && (static_cast<unsigned char>(c) & 0xC0) != 0x80) {
        ++column_;
      }
    }
  }
  int line() const { return line_; }
  int column() const { return column_; }

 private:
  std::string_view text_;
  std::size_t at_ = 0;
  int line_ = 1, column_ = 1;
};

}  // namespace insula
