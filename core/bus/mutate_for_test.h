// SPDX-License-Identifier: GPL-3.0-or-later
// Damaged messages for the decoder tests, from a seed, so that a failure can be repeated.
#pragma once
#include <algorithm>
#include <cstdint>
#include <limits>
#include <random>
#include <vector>

namespace insula::testing {

class Mutator {
 public:
  explicit Mutator(std::uint32_t seed) : random_(seed) {}

  /// A copy of `original` with one to four errors. The fingerprint (first 8 bytes) mostly stays, so that the decoder
  /// accepts it.
  std::vector<std::uint8_t> operator()(const std::vector<std::uint8_t>& original) {
    std::vector<std::uint8_t> bytes = original;
    const int hurts = 1 + int(below(4));
    for (int i = 0; i < hurts; ++i) hurt(bytes);
    return bytes;
  }

 private:
  std::size_t below(std::size_t n) { return std::uniform_int_distribution<std::size_t>(0, n - 1)(random_); }

  void put(std::vector<std::uint8_t>& b, std::size_t at, std::uint64_t value, std::size_t width) {
    for (std::size_t i = 0; i < width && at + i < b.size(); ++i)
      b[at + i] = std::uint8_t(value >> (8 * (width - 1 - i)));
  }

  void hurt(std::vector<std::uint8_t>& b) {
    if (b.size() < 10) {
      b.push_back(std::uint8_t(below(256)));
      return;
    }
    const std::size_t first = below(50) == 0 ? 0 : 8;
    const std::size_t at = first + below(b.size() - first);
    switch (below(9)) {
      case 0: b[at] ^= std::uint8_t(1u << below(8)); break;
      case 1: b[at] = std::uint8_t(below(256)); break;
      case 2: put(b, at, 0x7ff8000000000000u, 8); break;                                   // NaN
      case 3: put(b, at, below(2) ? 0x7ff0000000000000u : 0xfff0000000000000u, 8); break;  // infinities
      case 4: {                                                                            // counts
        static constexpr std::uint32_t odd[] = {0,          1,          0x7fffffff, 0x80000000,
                                                0xffffffff, 0xfffffff0, 0x00ffffff, 0x10000};
        put(b, at, odd[below(8)], 4);
        break;
      }
      case 5: put(b, at, below(2) ? 0x7fc00000u : 0x7f800000u, 4); break;  // float NaN, infinity
      case 6: b.resize(at); break;
      case 7: b.insert(b.begin() + std::ptrdiff_t(at), 1 + below(16), std::uint8_t(below(256))); break;
      default: {
        const std::size_t n = std::min<std::size_t>(1 + below(16), b.size() - at);
        b.erase(b.begin() + std::ptrdiff_t(at), b.begin() + std::ptrdiff_t(at + n));
      }
    }
  }

  std::mt19937 random_;
};

}  // namespace insula::testing
