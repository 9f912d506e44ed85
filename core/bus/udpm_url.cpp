// SPDX-License-Identifier: GPL-3.0-or-later
// Reading of udpm URLs.
#include "core/bus/udpm_url.h"

#include <charconv>

namespace insula {
namespace {

/// A whole decimal number from 0 to `most`, or nothing.
std::optional<long> number(std::string_view text, long most) {
  long value = -1;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc() || end != text.data() + text.size() || value < 0 || value > most) return std::nullopt;
  return value;
}

/// The text up to `mark`, which is removed from `rest` together with the mark.
std::string_view up_to(char mark, std::string_view& rest) {
  const std::size_t at = rest.find(mark);
  const std::string_view piece = rest.substr(0, at);
  rest.remove_prefix(at == std::string_view::npos ? rest.size() : at + 1);
  return piece;
}

bool parse_group(std::string_view text, std::array<std::uint8_t, 4>& group) {
  for (std::size_t i = 0; i < group.size(); ++i) {
    const auto byte = number(i + 1 < group.size() ? up_to('.', text) : text, 255);
    if (!byte) return false;
    group[i] = std::uint8_t(*byte);
  }
  return group[0] >= 224 && group[0] <= 239;
}

bool parse_option(std::string_view option, UdpmAddress& out) {
  const std::string_view name = up_to('=', option);
  if (name == "ttl") {
    const auto value = number(option, 255);
    if (value) out.ttl = int(*value);
    return value.has_value();
  }
  if (name == "recv_buf_size") {
    const auto value = number(option, 1L << 30);
    if (value) out.receive_buffer_bytes = int(*value);
    return value.has_value();
  }
  return false;
}

}  // namespace

std::optional<UdpmAddress> parse_udpm_url(std::string_view url) {
  constexpr std::string_view scheme = "udpm://";
  if (!url.starts_with(scheme)) return std::nullopt;
  url.remove_prefix(scheme.size());
  UdpmAddress out;
  std::string_view place = up_to('?', url);
  const bool with_port = place.find(':') != std::string_view::npos;
  const std::string_view group = up_to(':', place);
  if (!group.empty() && !parse_group(group, out.group)) return std::nullopt;
  if (with_port) {
    const auto port = number(place, 65535);
    if (!port || *port == 0) return std::nullopt;
    out.port = std::uint16_t(*port);
  }
  while (!url.empty())
    if (const std::string_view option = up_to('&', url); !option.empty() && !parse_option(option, out))
      return std::nullopt;
  return out;
}

}  // namespace insula
