// SPDX-License-Identifier: GPL-3.0-or-later
// DataArrays of VTK XML files: ASCII, base64, raw, zlib blocks ("VTK XML Formats", VTK documentation).
#include "core/model/formats/vtu_data.h"

#include <zlib.h>

#include <algorithm>

#include "core/base/text.h"

namespace insula {
namespace {

int base64_value(char c) {
  if (c >= 'A' && c <= 'Z') return c - 'A';
  if (c >= 'a' && c <= 'z') return c - 'a' + 26;
  if (c >= '0' && c <= '9') return c - '0' + 52;
  return c == '+' ? 62 : c == '/' ? 63 : -1;
}

/// A stored array as a stream of bytes from its first one; header and data may be encoded apart, each with its padding.
class Stored {
 public:
  Stored(const std::filesystem::path& file, const std::string& name, std::string_view source, bool base64)
      : file_(file), name_(name), source_(source), base64_(base64) {}

  /// The next n bytes.
  std::string take(std::size_t n) {
    if (!base64_) {
      if (n > source_.size()) ends_early();
      std::string out(source_.substr(0, n));
      source_.remove_prefix(n);
      return out;
    }
    if (n / 4 * 3 > source_.size() + buffer_.size() + 4) ends_early();
    while (buffer_.size() < n) group();
    std::string out = buffer_.substr(0, n);
    buffer_.erase(0, n);
    return out;
  }

  [[noreturn]] void ends_early() const { fail(file_, "ends early: the array " + in_quotes(name_) + " is short"); }

 private:
  void group() {
    char four[4];
    int n = 0;
    while (n < 4) {
      while (!source_.empty() && is_blank(source_.front())) source_.remove_prefix(1);
      if (source_.empty()) ends_early();
      four[n++] = source_.front();
      source_.remove_prefix(1);
    }
    unsigned bits = 0;
    int padding = 0;
    for (char c : four) {
      const int v = base64_value(c);
      if (c == '=') ++padding;
      else if (v < 0 || padding > 0) fail(file_, "the array " + in_quotes(name_) + " is no base64");
      bits = bits << 6 | unsigned(std::max(v, 0));
    }
    if (padding > 2) fail(file_, "the array " + in_quotes(name_) + " is no base64");
    for (int k = 0; k < 3 - padding; ++k) buffer_ += char(bits >> (16 - 8 * k) & 255);
  }

  const std::filesystem::path& file_;
  const std::string& name_;
  std::string_view source_;
  std::string buffer_;
  bool base64_;
};

std::uint64_t header_number(const std::filesystem::path& file, const VtuFormat& format, Stored& stored) {
  const std::string raw = stored.take(format.header64 ? 8 : 4);
  ByteCursor in(file, raw);
  return format.header64 ? in.binary<std::uint64_t>(format.swap, "a header")
                         : in.binary<std::uint32_t>(format.swap, "a header");
}

std::string plain_bytes(const std::filesystem::path& file, const VtuFormat& format, const VtuArray& array,
                        std::string_view source, bool base64) {
  Stored stored(file, array.name, source, base64);
  constexpr std::uint64_t too_many = std::uint64_t(1) << 40;
  if (!format.zlib) {
    const std::uint64_t n = header_number(file, format, stored);
    if (n > source.size()) stored.ends_early();
    return stored.take(std::size_t(n));
  }
  const std::uint64_t blocks = header_number(file, format, stored);
  const std::uint64_t block_size = header_number(file, format, stored), last_size = header_number(file, format, stored);
  if (blocks > source.size()) stored.ends_early();
  if (block_size > too_many || last_size > too_many) fail(file, "the array " + in_quotes(array.name) + " is malformed");
  std::vector<std::uint64_t> packed;
  for (std::uint64_t b = 0; b < blocks; ++b) packed.push_back(header_number(file, format, stored));
  std::string out;
  for (std::uint64_t b = 0; b < blocks; ++b) {
    const std::uint64_t size = b + 1 == blocks && last_size > 0 ? last_size : block_size;
    if (packed[b] > source.size()) stored.ends_early();
    // Deflate compresses by at most 1032 to 1. A larger size is wrong, and nothing is allocated for it.
    if (size > 1040 * packed[b] + 64) fail(file, "the array " + in_quotes(array.name) + " is malformed");
    const std::string in = stored.take(std::size_t(packed[b]));
    const std::size_t at = out.size();
    out.resize(at + std::size_t(size));
    uLongf got = uLongf(size);
    if (uncompress(reinterpret_cast<Bytef*>(out.data() + at), &got, reinterpret_cast<const Bytef*>(in.data()),
                   uLong(in.size())) != Z_OK ||
        got != size)
      fail(file, "the array " + in_quotes(array.name) + " does not unpack");
  }
  return out;
}

VtkType type_of(const std::filesystem::path& file, const VtuArray& array) {
  static constexpr std::pair<std::string_view, VtkType> names[] = {
      {"Int8", VtkType::i8},     {"UInt8", VtkType::u8},   {"Int16", VtkType::i16}, {"UInt16", VtkType::u16},
      {"Int32", VtkType::i32},   {"UInt32", VtkType::u32}, {"Int64", VtkType::i64}, {"UInt64", VtkType::u64},
      {"Float32", VtkType::f32}, {"Float64", VtkType::f64}};
  for (const auto& [name, t] : names)
    if (name == array.type) return t;
  fail(file, "the array " + in_quotes(array.name) + " has an unknown type " + in_quotes(array.type));
}

}  // namespace

std::vector<double> vtu_numbers(const std::filesystem::path& file, const VtuFormat& format, const VtuArray& array,
                                std::int64_t expected) {
  const VtkType type = type_of(file, array);
  std::vector<double> out;
  if (array.format == "ascii") {
    ByteCursor in(file, array.text);
    for (std::string_view w = in.try_word(); !w.empty(); w = in.try_word()) {
      double v = 0;
      if (!parse_double(w, v))
        fail(file, "the array " + in_quotes(array.name) + " holds " + in_quotes(w) + ", which is no number");
      out.push_back(v);
    }
  } else {
    std::string bytes;
    if (array.format == "binary") {
      bytes = plain_bytes(file, format, array, array.text, true);
    } else if (array.format == "appended") {
      if (array.offset > format.appended.size())
        fail(file, "ends early: the array " + in_quotes(array.name) + " is missing");
      bytes = plain_bytes(file, format, array, format.appended.substr(array.offset), !format.appended_raw);
    } else {
      fail(file, "the array " + in_quotes(array.name) + " has an unknown format " + in_quotes(array.format));
    }
    ByteCursor in(file, bytes);
    const std::size_t n = bytes.size() / size_of(type);
    out.reserve(n);
    for (std::size_t i = 0; i < n; ++i) out.push_back(read_value(in, type, format.swap, "a value"));
  }
  if (expected >= 0 && std::int64_t(out.size()) != expected)
    fail(file, "the array " + in_quotes(array.name) + " holds " + std::to_string(out.size()) + " numbers and not " +
                   std::to_string(expected));
  return out;
}

}  // namespace insula
