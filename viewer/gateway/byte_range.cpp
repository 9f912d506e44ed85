// SPDX-License-Identifier: GPL-3.0-or-later
#include "viewer/gateway/byte_range.h"

#include <algorithm>
#include <charconv>

namespace insula::gateway {
namespace {

/// Nothing unless the whole text is a number of 64 bits.
std::optional<std::uint64_t> whole_number(std::string_view text) {
  std::uint64_t value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc() || end != text.data() + text.size()) return std::nullopt;
  return value;
}

}  // namespace

std::optional<ByteRange> byte_range(std::string_view header, std::uint64_t size) {
  constexpr std::string_view unit = "bytes=";
  if (!header.starts_with(unit)) return std::nullopt;
  header.remove_prefix(unit.size());
  const std::size_t dash = header.find('-');
  if (dash == std::string_view::npos) return std::nullopt;
  const auto from = whole_number(header.substr(0, dash)), to = whole_number(header.substr(dash + 1));
  if (dash == 0) {
    if (!to) return std::nullopt;
    const std::uint64_t length = std::min(*to, size);
    return ByteRange{size - length, length};
  }
  const bool open = dash + 1 == header.size();
  if (!from || (!open && (!to || *to < *from))) return std::nullopt;
  if (*from >= size) return ByteRange{*from, 0};
  const std::uint64_t last = open ? size - 1 : std::min(*to, size - 1);
  return ByteRange{*from, last - *from + 1};
}

}  // namespace insula::gateway
