// SPDX-License-Identifier: GPL-3.0-or-later
#include "training/xapi/identifiers.h"

#include <fmt/format.h>
#include <openssl/evp.h>

#include <algorithm>
#include <array>
#include <cstdint>

#include "core/base/input_error.h"
#include "core/base/text.h"

namespace insula::xapi {
namespace {

constexpr std::string_view digits = "0123456789abcdef";

bool is_letter(char c) { return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z'); }
bool is_digit(char c) { return c >= '0' && c <= '9'; }
bool is_hex(char c) { return is_digit(c) || (c >= 'a' && c <= 'f') || (c >= 'A' && c <= 'F'); }

std::string bytes_of(std::string_view uuid) {
  if (!is_uuid(uuid)) throw InputError(fmt::format("{} is no UUID", in_quotes(uuid)));
  std::string out;
  int high = -1;
  for (const char c : uuid) {
    if (c == '-') continue;
    const int value = is_digit(c) ? c - '0' : (c | 0x20) - 'a' + 10;
    if (high < 0) high = value;
    else out += char(high * 16 + value), high = -1;
  }
  return out;
}

}  // namespace

bool is_uuid(std::string_view text) {
  if (text.size() != 36) return false;
  for (std::size_t i = 0; i < text.size(); ++i) {
    const bool dash = i == 8 || i == 13 || i == 18 || i == 23;
    if (dash ? text[i] != '-' : !is_hex(text[i])) return false;
  }
  return true;
}

std::string uuid_v5(std::string_view space, std::string_view name) {
  const std::string bytes = bytes_of(space) + std::string(name);
  std::array<unsigned char, EVP_MAX_MD_SIZE> hash{};
  unsigned n = 0;
  if (EVP_Digest(bytes.data(), bytes.size(), hash.data(), &n, EVP_sha1(), nullptr) != 1)
    throw InputError("SHA-1 is not available");
  hash[6] = std::uint8_t((hash[6] & 0x0f) | 0x50);
  hash[8] = std::uint8_t((hash[8] & 0x3f) | 0x80);
  std::string out;
  for (std::size_t i = 0; i < 16; ++i) {
    if (i == 4 || i == 6 || i == 8 || i == 10) out += '-';
    out += digits[hash[i] >> 4];
    out += digits[hash[i] & 15];
  }
  return out;
}

bool is_iri(std::string_view text) {
  const std::size_t colon = text.find(':');
  if (colon == std::string_view::npos || colon == 0 || colon + 1 == text.size() || !is_letter(text[0])) return false;
  const auto in_scheme = [](char c) { return is_letter(c) || is_digit(c) || c == '+' || c == '-' || c == '.'; };
  if (!std::all_of(text.begin(), text.begin() + std::ptrdiff_t(colon), in_scheme)) return false;
  const auto never = [](char c) {
    return static_cast<unsigned char>(c) <= 0x20 || c == 0x7f ||
           std::string_view("<>\"{}|\\^`").find(c) != std::string_view::npos;
  };
  return std::none_of(text.begin(), text.end(), never) && find_invalid_utf8(text) == std::string_view::npos;
}

std::string encoded(std::string_view part) {
  std::string out;
  for (const char c : part) {
    if (is_letter(c) || is_digit(c) || std::string_view("-._~").find(c) != std::string_view::npos) out += c;
    else out += fmt::format("%{:02X}", static_cast<unsigned char>(c));
  }
  return out;
}

}  // namespace insula::xapi
