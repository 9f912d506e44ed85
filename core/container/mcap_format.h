// SPDX-License-Identifier: GPL-3.0-or-later
// The bytes of an MCAP file, version 0 (mcap.dev/spec): magic, records "opcode, length, content", little-endian
// numbers.
#pragma once
#include <array>
#include <bit>
#include <cstdint>
#include <cstring>
#include <map>
#include <span>
#include <string>
#include <string_view>
#include <type_traits>
#include <vector>

namespace insula::mcap {

using Bytes = std::span<const std::uint8_t>;
using Buffer = std::vector<std::uint8_t>;
using Text = std::map<std::string, std::string>;  ///< key, value

inline constexpr std::array<std::uint8_t, 8> magic = {0x89, 'M', 'C', 'A', 'P', '0', '\r', '\n'};

enum class Op : std::uint8_t {
  header = 1,
  footer,
  schema,
  channel,
  message,
  chunk,
  message_index,
  chunk_index,
  attachment,
  attachment_index,
  statistics,
  metadata,
  metadata_index,
  summary_offset,
  data_end
};

inline constexpr std::size_t record_head = 9;    ///< bytes of opcode and length
inline constexpr std::size_t message_head = 22;  ///< bytes of a message before its data
/// Bytes at the end of a whole file: the footer's record and the magic.
inline constexpr std::size_t tail_bytes = record_head + 20 + magic.size();
/// Larger chunks are refused by the reader. The writer ends a chunk long before.
inline constexpr std::uint64_t max_chunk_bytes = 64u << 20;

static_assert(std::endian::native == std::endian::little, "numbers are copied as they are");

/// Appends numbers and strings to a buffer.
class Put {
 public:
  explicit Put(Buffer& to) : to_(to) {}

  template <class T>
  Put& number(T value) {
    static_assert(std::is_integral_v<T>);
    return raw({reinterpret_cast<const std::uint8_t*>(&value), sizeof value});
  }
  Put& raw(Bytes bytes) {
    if (bytes.empty()) return *this;
    const std::size_t n = to_.size();
    to_.resize(n + bytes.size());
    std::memcpy(to_.data() + n, bytes.data(), bytes.size());
    return *this;
  }
  Put& string(std::string_view text) {
    number(std::uint32_t(text.size()));
    return raw({reinterpret_cast<const std::uint8_t*>(text.data()), text.size()});
  }
  Put& text(const Text& map) {
    std::uint32_t size = 0;
    for (const auto& [key, value] : map) size += std::uint32_t(8 + key.size() + value.size());
    number(size);
    for (const auto& [key, value] : map) string(key).string(value);
    return *this;
  }

 private:
  Buffer& to_;
};

/// Reads from front to back. After the first read past the end, every read gives zero and ok() is false.
class Take {
 public:
  explicit Take(Bytes bytes) : bytes_(bytes) {}

  template <class T>
  T number() {
    T value{};
    if (const Bytes b = raw(sizeof value); !b.empty()) std::memcpy(&value, b.data(), sizeof value);
    return value;
  }
  Bytes raw(std::uint64_t n) {
    if (!ok_ || n > bytes_.size() - at_) {
      ok_ = false;
      return {};
    }
    at_ += std::size_t(n);
    return bytes_.subspan(at_ - std::size_t(n), std::size_t(n));
  }
  std::string string() {
    const Bytes b = raw(number<std::uint32_t>());
    return {b.begin(), b.end()};
  }
  Text text() {
    Text out;
    Take inside(raw(number<std::uint32_t>()));
    while (inside.ok() && inside.left() > 0) {
      std::string key = inside.string();
      out[std::move(key)] = inside.string();
    }
    ok_ = ok_ && inside.ok();
    return out;
  }
  Bytes rest() { return raw(left()); }
  std::size_t at() const { return at_; }
  std::size_t left() const { return ok_ ? bytes_.size() - at_ : 0; }
  bool ok() const { return ok_; }

 private:
  Bytes bytes_;
  std::size_t at_ = 0;
  bool ok_ = true;
};

/// CRC-32 of IEEE 802.3, as MCAP has it.
std::uint32_t crc32(Bytes bytes, std::uint32_t before = 0);

}  // namespace insula::mcap
