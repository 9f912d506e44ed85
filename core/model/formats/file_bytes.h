// SPDX-License-Identifier: GPL-3.0-or-later
// The bytes of a mesh file and a cursor over them that refuses to read past the end. All failures are InputErrors that
// start with the file's name.
#pragma once
#include <array>
#include <bit>
#include <cstdint>
#include <cstring>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "core/base/input_error.h"

namespace insula {

/// Throws InputError "FILE: text".
[[noreturn]] void fail(const std::filesystem::path& file, const std::string& text);

/// The whole of a regular file of at most `limit` bytes.
std::string read_file_bytes(const std::filesystem::path& file, std::size_t limit = std::size_t(1) << 30);

/// Lower-case extension with its dot, ".msh".
std::string lower_extension(const std::filesystem::path& file);

/// Reads words, lines and binary values from memory, front to back.
class ByteCursor {
 public:
  ByteCursor(const std::filesystem::path& file, std::string_view data) : file_(file), data_(data) {}

  const std::filesystem::path& file() const { return file_; }
  std::size_t left() const { return data_.size() - at_; }
  std::size_t offset() const { return at_; }
  void seek(std::size_t offset);
  std::string_view rest() const { return data_.substr(at_); }

  /// The next word between blanks, empty at the end.
  std::string_view try_word();
  /// The next word; `what` is its name in the message if there is none.
  std::string_view word(const char* what);
  /// The rest of the line, without its end.
  std::string_view line();
  double number(const char* what);
  std::int64_t integer(const char* what);
  /// A count of things that take at least `bytes_each` of the remaining bytes. This keeps hostile counts from
  /// allocating.
  std::size_t count(const char* what, std::size_t bytes_each);
  /// The same check for a count that was read elsewhere.
  std::size_t checked_count(std::int64_t n, const char* what, std::size_t bytes_each) const;
  /// Skips everything up to and including the next `mark`.
  void skip_past(std::string_view mark);

  std::string_view bytes(std::size_t n, const char* what);
  /// A binary value; `swap` when the file's byte order is not the machine's.
  template <class T>
  T binary(bool swap, const char* what) {
    T value;
    const std::string_view raw = bytes(sizeof(T), what);
    std::array<char, sizeof(T)> buffer;
    for (std::size_t i = 0; i < sizeof(T); ++i) buffer[i] = raw[swap ? sizeof(T) - 1 - i : i];
    std::memcpy(&value, buffer.data(), sizeof(T));
    return value;
  }

  [[noreturn]] void fail(const std::string& text) const { insula::fail(file_, text); }
  [[noreturn]] void fail_short(const char* what) const;

 private:
  std::filesystem::path file_;
  std::string_view data_;
  std::size_t at_ = 0;
};

/// Reads the whole word as a number, also "nan" and "inf", which the mesh check refuses by name. False if it is not a
/// number.
bool parse_double(std::string_view word, double& value);
bool parse_integer(std::string_view word, std::int64_t& value);

inline constexpr bool machine_is_little_endian = std::endian::native == std::endian::little;

}  // namespace insula
