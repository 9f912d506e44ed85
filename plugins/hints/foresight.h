// SPDX-License-Identifier: GPL-3.0-or-later
// Carries a value on at its present rate, for hints on what rises faster than a person reacts.
#pragma once
#include <cmath>

namespace insula {

class Foresight {
 public:
  /// Time constant of the rate, a first-order filter: noise of single steps does not count, s.
  static constexpr double smoothing_s = 0.05;

  /// The value as it would be `ahead` s later. It is the value itself at first, and NaN if the value is not known.
  /// h: since the last call, s.
  double carried_on(double value, double ahead, double h) {
    if (std::isfinite(value) && std::isfinite(last_) && h > 0)
      rate_ += h / (smoothing_s + h) * ((value - last_) / h - rate_);
    else rate_ = 0;
    last_ = value;
    return value + ahead * rate_;
  }

 private:
  double last_ = std::nan(""), rate_ = 0;
};

}  // namespace insula
