// SPDX-License-Identifier: GPL-3.0-or-later
// Suggestions for misspelt names. A hostile scene may hold 99,000 wrong names and as many good ones. All comparisons of
// one load are therefore limited, and errors beyond the limit have no suggestion.
#pragma once
#include <cstddef>

namespace insula {

class Suggestions {
 public:
  static constexpr std::size_t max_comparisons = 500'000;  ///< about 0.1 s

  /// Whether so many more names may be compared. Call it before the names are collected.
  bool afford(std::size_t comparisons) {
    if (comparisons > left_) return false;
    left_ -= comparisons;
    return true;
  }

 private:
  std::size_t left_ = max_comparisons;
};

}  // namespace insula
