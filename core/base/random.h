// SPDX-License-Identifier: GPL-3.0-or-later
// A small random generator that gives the same numbers on every machine and with every library.
#pragma once
#include <cstdint>

namespace insula {

/// PCG-XSH-RR 64/32 (O'Neill 2014).
class Random {
 public:
  explicit Random(std::uint64_t seed, std::uint64_t stream = 0) : increment_((stream << 1) | 1) {
    next();
    state_ += seed;
    next();
  }
  std::uint32_t next() {
    const std::uint64_t old = state_;
    state_ = old * 6364136223846793005ull + increment_;
    const auto x = static_cast<std::uint32_t>(((old >> 18) ^ old) >> 27);
    const auto r = static_cast<std::uint32_t>(old >> 59);
    return (x >> r) | (x << ((32 - r) & 31));
  }
  /// [0, 1)
  double uniform() { return next() * (1.0 / 4294967296.0); }
  double uniform(double a, double b) { return a + (b - a) * uniform(); }
  /// 0 ... n - 1
  std::uint32_t below(std::uint32_t n) { return static_cast<std::uint32_t>((std::uint64_t(next()) * n) >> 32); }

 private:
  std::uint64_t state_ = 0, increment_;
};

}  // namespace insula
