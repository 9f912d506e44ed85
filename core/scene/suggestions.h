// SPDX-License-Identifier: GPL-3.0-or-later
// Names suggested for what was probably meant. A hostile scene may hold 99,000 wrong names and as many good ones, so
// all comparisons of one load are limited; beyond the limit errors come without a suggestion.
#pragma once
#include <cstddef>

namespace insula {

class Suggestions {
 public:
  static constexpr std::size_t max_comparisons = 500'000;  ///< about 0.1 s

  /// Whether so many more names may be compared. To be asked before they are collected.
  bool afford(std::size_t comparisons) {
    if (comparisons > left_) return false;
    left_ -= comparisons;
    return true;
  }

 private:
  std::size_t left_ = max_comparisons;
};

}  // namespace insula
