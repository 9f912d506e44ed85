// SPDX-License-Identifier: GPL-3.0-or-later
// The bytes of a mesh file and a cursor over them.
#include "core/model/formats/file_bytes.h"

#include <algorithm>
#include <charconv>
#include <fstream>

#include "core/base/decimal.h"
#include "core/base/text.h"

namespace insula {

void fail(const std::filesystem::path& file, const std::string& text) { throw InputError(file.string() + ": " + text); }

std::string read_file_bytes(const std::filesystem::path& file, std::size_t limit) {
  std::error_code error;
  const auto status = std::filesystem::status(file, error);
  if (!std::filesystem::exists(status)) fail(file, "no such file");
  if (!std::filesystem::is_regular_file(status)) fail(file, "is not a file");
  const auto size = std::filesystem::file_size(file, error);
  if (error) fail(file, "cannot be read");
  if (size > limit) fail(file, "is larger than the limit of " + std::to_string(limit >> 20) + " MiB");
  std::ifstream in(file, std::ios::binary);
  std::string data(std::size_t(size), '\0');
  if (!in || !in.read(data.data(), std::streamsize(data.size()))) fail(file, "cannot be read");
  if (data.empty()) fail(file, "is empty");
  return data;
}

std::string lower_extension(const std::filesystem::path& file) {
  std::string text = file.extension().string();
  std::transform(text.begin(), text.end(), text.begin(),
                 [](char c) { return c >= 'A' && c <= 'Z' ? char(c - 'A' + 'a') : c; });
  return text;
}

bool parse_double(std::string_view word, double& value) {
  if (word.size() > 1 && word.front() == '+' && word[1] != '-') word.remove_prefix(1);
  const auto [end, code] = read_decimal(word.data(), word.data() + word.size(), value);
  if (code == std::errc::result_out_of_range && end == word.data() + word.size()) {
    // read_decimal does not change the value then. Too small a number counts as 0. Too large a number is refused later
    // as not finite.
    const bool tiny = word.find("e-") != std::string_view::npos || word.find("E-") != std::string_view::npos;
    value = tiny ? 0.0 : std::numeric_limits<double>::infinity();
    return true;
  }
  return code == std::errc() && end == word.data() + word.size();
}

bool parse_integer(std::string_view word, std::int64_t& value) {
  const auto [end, code] = std::from_chars(word.data(), word.data() + word.size(), value);
  return code == std::errc() && end == word.data() + word.size();
}

void ByteCursor::fail_short(const char* what) const { fail(std::string("ends early: ") + what + " is missing"); }

void ByteCursor::seek(std::size_t offset) {
  if (offset > data_.size()) fail("ends early");
  at_ = offset;
}

std::string_view ByteCursor::try_word() {
  while (at_ < data_.size() && is_blank(data_[at_])) ++at_;
  const std::size_t begin = at_;
  while (at_ < data_.size() && !is_blank(data_[at_])) ++at_;
  return data_.substr(begin, at_ - begin);
}

std::string_view ByteCursor::word(const char* what) {
  const std::string_view w = try_word();
  if (w.empty()) fail_short(what);
  return w;
}

std::string_view ByteCursor::line() {
  const std::size_t begin = at_;
  const std::size_t end = data_.find('\n', at_);
  if (end == std::string_view::npos) {
    at_ = data_.size();
    return data_.substr(begin);
  }
  at_ = end + 1;
  std::string_view text = data_.substr(begin, end - begin);
  if (!text.empty() && text.back() == '\r') text.remove_suffix(1);
  return text;
}

double ByteCursor::number(const char* what) {
  const std::string_view w = word(what);
  double value = 0;
  if (!parse_double(w, value)) fail(std::string(what) + ": " + in_quotes(w) + " is not a number");
  return value;
}

std::int64_t ByteCursor::integer(const char* what) {
  const std::string_view w = word(what);
  std::int64_t value = 0;
  if (!parse_integer(w, value)) fail(std::string(what) + ": " + in_quotes(w) + " is not a whole number");
  return value;
}

std::size_t ByteCursor::checked_count(std::int64_t n, const char* what, std::size_t bytes_each) const {
  if (n < 0) fail(std::string(what) + ": a count cannot be " + std::to_string(n));
  if (std::uint64_t(n) > left() / std::max<std::size_t>(bytes_each, 1) + 1)
    fail(std::string("ends early: it announces ") + what + " " + std::to_string(n) + ", and too few bytes follow");
  return std::size_t(n);
}

std::size_t ByteCursor::count(const char* what, std::size_t bytes_each) {
  return checked_count(integer(what), what, bytes_each);
}

void ByteCursor::skip_past(std::string_view mark) {
  const std::size_t found = data_.find(mark, at_);
  if (found == std::string_view::npos) fail("ends early: \"" + std::string(mark) + "\" is missing");
  at_ = found + mark.size();
}

std::string_view ByteCursor::bytes(std::size_t n, const char* what) {
  if (n > left()) fail_short(what);
  const std::string_view out = data_.substr(at_, n);
  at_ += n;
  return out;
}

}  // namespace insula
