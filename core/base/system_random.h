// SPDX-License-Identifier: GPL-3.0-or-later
// Secrets drawn from the system's random source, which std::random_device is on the platforms of Insula.
#pragma once
#include <random>
#include <string>

namespace insula {

/// That many characters of an alphabet, each equally likely.
inline std::string system_random(std::size_t length, const std::string& alphabet) {
  std::random_device source;
  std::uniform_int_distribution<std::size_t> one(0, alphabet.size() - 1);
  std::string out;
  for (std::size_t i = 0; i < length; ++i) out += alphabet[one(source)];
  return out;
}

}  // namespace insula
