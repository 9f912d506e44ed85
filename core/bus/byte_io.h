// SPDX-License-Identifier: GPL-3.0-or-later
// Reading and writing of big-endian numbers with bounds checks, for LCM's wire format.
#pragma once
#include <bit>
#include <cstdint>
#include <cstring>
#include <string_view>
#include <vector>

#include "core/bus/bus.h"

namespace insula {

namespace wire {

inline std::uint64_t load64(const std::uint8_t* p) {
  std::uint64_t v;
  std::memcpy(&v, p, 8);
  return __builtin_bswap64(v);
}
inline std::uint32_t load32(const std::uint8_t* p) {
  std::uint32_t v;
  std::memcpy(&v, p, 4);
  return __builtin_bswap32(v);
}
inline std::uint16_t load16(const std::uint8_t* p) {
  std::uint16_t v;
  std::memcpy(&v, p, 2);
  return __builtin_bswap16(v);
}
/// A number of any wire type.
template <class T>
T load(const std::uint8_t* p) {
  if constexpr (sizeof(T) == 8) return std::bit_cast<T>(load64(p));
  else if constexpr (sizeof(T) == 4) return std::bit_cast<T>(load32(p));
  else if constexpr (sizeof(T) == 2) return std::bit_cast<T>(load16(p));
  else return std::bit_cast<T>(*p);
}
inline double load_double(const std::uint8_t* p) { return std::bit_cast<double>(load64(p)); }
inline float load_float(const std::uint8_t* p) { return std::bit_cast<float>(load32(p)); }

}  // namespace wire
static_assert(std::endian::native == std::endian::little, "wire:: swaps bytes");

/// Reads a message from front to back. After the first read past the end, every read gives zero and ok() is false.
class ByteReader {
 public:
  explicit ByteReader(Bytes bytes) : bytes_(bytes) {}

  /// The next n bytes, or null when there are fewer left.
  const std::uint8_t* take(std::size_t n) {
    if (!ok_ || n > bytes_.size() - at_) {
      ok_ = false;
      return nullptr;
    }
    const std::uint8_t* p = bytes_.data() + at_;
    at_ += n;
    return p;
  }
  /// An array of `count` items of `size` bytes; negative counts fail.
  const std::uint8_t* take_array(std::int64_t count, std::size_t size) {
    if (count < 0 || std::uint64_t(count) > bytes_.size()) {  // also keeps count * size far from overflow
      ok_ = false;
      return nullptr;
    }
    return take(std::size_t(count) * size);
  }
  std::int64_t i64() {
    const auto* p = take(8);
    return p != nullptr ? std::int64_t(wire::load64(p)) : 0;
  }
  std::int32_t i32() {
    const auto* p = take(4);
    return p != nullptr ? std::int32_t(wire::load32(p)) : 0;
  }
  std::int8_t i8() {
    const auto* p = take(1);
    return p != nullptr ? std::int8_t(*p) : std::int8_t(0);
  }
  double f64() { return std::bit_cast<double>(i64()); }
  /// A string: length with the final NUL, characters, NUL. Fails if the form is wrong.
  bool skip_string() {
    const std::int32_t length = i32();
    const std::uint8_t* p = length < 1 ? nullptr : take(std::size_t(length));
    if (p == nullptr || p[length - 1] != 0) ok_ = false;
    return ok_;
  }
  bool ok() const { return ok_; }
  bool at_end() const { return ok_ && at_ == bytes_.size(); }
  std::size_t left() const { return bytes_.size() - at_; }

 private:
  Bytes bytes_;
  std::size_t at_ = 0;
  bool ok_ = true;
};

/// Appends to a vector whose capacity is kept from message to message.
class ByteWriter {
 public:
  explicit ByteWriter(std::vector<std::uint8_t>& out) : out_(out) { out_.clear(); }

  void i64(std::int64_t v) { put(__builtin_bswap64(std::uint64_t(v))); }
  void i32(std::int32_t v) { put(__builtin_bswap32(std::uint32_t(v))); }
  void i16(std::int16_t v) { put(__builtin_bswap16(std::uint16_t(v))); }
  void i8(std::int8_t v) { out_.push_back(std::uint8_t(v)); }
  void f64(double v) { i64(std::bit_cast<std::int64_t>(v)); }
  void f32(float v) { i32(std::bit_cast<std::int32_t>(v)); }
  /// A number of any wire type.
  template <class T>
  void number(T v) {
    if constexpr (sizeof(T) == 8) i64(std::bit_cast<std::int64_t>(v));
    else if constexpr (sizeof(T) == 4) i32(std::bit_cast<std::int32_t>(v));
    else if constexpr (sizeof(T) == 2) i16(std::bit_cast<std::int16_t>(v));
    else i8(std::bit_cast<std::int8_t>(v));
  }

 private:
  template <class U>
  void put(U u) {
    const std::size_t n = out_.size();
    out_.resize(n + sizeof u);
    std::memcpy(out_.data() + n, &u, sizeof u);
  }
  std::vector<std::uint8_t>& out_;
};

}  // namespace insula
