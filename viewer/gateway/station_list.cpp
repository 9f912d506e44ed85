// SPDX-License-Identifier: GPL-3.0-or-later
#include "viewer/gateway/station_list.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <fstream>

#include "core/base/input_error.h"
#include "core/base/text.h"
#include "viewer/gateway/access.h"

namespace insula::gateway {
namespace {

constexpr std::string_view plain = "http://", encrypted = "https://";

/// Empty if the text is no address of a station.
std::string read_url(std::string_view url, StationAddress& out) {
  out.encrypted = url.starts_with(encrypted);
  if (!out.encrypted && !url.starts_with(plain)) return "an address begins with http:// or https://";
  url.remove_prefix(out.encrypted ? encrypted.size() : plain.size());
  if (url.ends_with('/')) url.remove_suffix(1);
  out.host = host_name(url);
  const std::size_t colon = url.rfind(':');
  const bool given = colon != std::string_view::npos && url.find(']', colon) == std::string_view::npos;
  out.port = given ? std::string(url.substr(colon + 1)) : out.encrypted ? "443" : "80";
  int port = 0;
  const auto [end, error] = std::from_chars(out.port.data(), out.port.data() + out.port.size(), port);
  const bool good = error == std::errc() && end == out.port.data() + out.port.size() && port > 0 && port < 65536;
  return out.host.empty() || !good ? "this is no address of a station" : "";
}

bool is_fingerprint(const std::string& text) {
  const auto good = [](char c) { return (c >= '0' && c <= '9') || (c >= 'A' && c <= 'F') || c == ':'; };
  return text.size() == 95 && std::all_of(text.begin(), text.end(), good);
}

std::string read_line(const std::vector<std::string_view>& words, StationAddress& out) {
  if (words.size() < 2 || words.size() > 3) return "expected NAME URL, and perhaps the SHA-256 of a certificate";
  out.name = words[0];
  if (words.size() == 3) out.fingerprint = words[2];
  if (!out.fingerprint.empty() && !is_fingerprint(out.fingerprint))
    return "a SHA-256 has 32 pairs of digits such as AB, with colons between them";
  if (std::string why = read_url(words[1], out); !why.empty()) return why;
  return !out.fingerprint.empty() && !out.encrypted ? "only https:// has a certificate" : "";
}

}  // namespace

std::string StationAddress::host_and_port() const {
  return fmt::format("{}:{}", host.find(':') == host.npos ? host : "[" + host + "]", port);
}

std::string StationAddress::url() const {
  return fmt::format("{}{}/", encrypted ? "https://" : "http://", host_and_port());
}

std::vector<StationAddress> read_stations(const std::filesystem::path& file) {
  std::ifstream in(file);
  if (!in) throw InputError(fmt::format("{} cannot be read", file.string()));
  std::vector<StationAddress> out;
  int number = 0;
  for (std::string line; std::getline(in, line);) {
    ++number;
    const std::vector<std::string_view> words = split_blanks(std::string_view(line).substr(0, line.find('#')));
    if (words.empty()) continue;
    StationAddress station;
    std::string why = read_line(words, station);
    if (out.size() == most_stations) why = fmt::format("a room has at most {} stations", most_stations);
    if (!why.empty()) throw InputError(fmt::format("{}:{}: error: {}", file.string(), number, why));
    out.push_back(std::move(station));
  }
  if (out.empty()) throw InputError(fmt::format("{} names no station", file.string()));
  return out;
}

}  // namespace insula::gateway
