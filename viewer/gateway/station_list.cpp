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
constexpr std::size_t longest_name = 63;

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

bool is_name(std::string_view text) {
  const auto control = [](char c) { return static_cast<unsigned char>(c) < 0x20 || c == 0x7f; };
  return !text.empty() && text.size() <= longest_name && find_invalid_utf8(text) == text.npos &&
         std::none_of(text.begin(), text.end(), control);
}

StationAddress read_line(const std::vector<std::string_view>& words) {
  if (words.size() < 2 || words.size() > 3)
    throw InputError("expected NAME URL, and perhaps the SHA-256 of a certificate");
  return station_of(words[0], words[1], words.size() == 3 ? words[2] : "");
}

}  // namespace

std::string StationAddress::host_and_port() const {
  return fmt::format("{}:{}", host.find(':') == host.npos ? host : "[" + host + "]", port);
}

std::string StationAddress::url() const {
  return fmt::format("{}{}/", encrypted ? "https://" : "http://", host_and_port());
}

StationAddress station_of(std::string_view name, std::string_view url, std::string_view fingerprint) {
  StationAddress out;
  out.name = name;
  out.fingerprint = fingerprint;
  if (!is_name(name)) throw InputError("a name has 1 to 63 bytes");
  if (std::string why = read_url(url, out); !why.empty()) throw InputError(why);
  if (fingerprint.empty()) return out;
  if (!is_fingerprint(out.fingerprint))
    throw InputError("a SHA-256 has 32 pairs of digits such as AB, with colons between them");
  if (!out.encrypted) throw InputError("only https:// has a certificate");
  return out;
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
    try {
      out.push_back(read_line(words));
      if (out.size() > most_stations) throw InputError(fmt::format("a room has at most {} stations", most_stations));
    } catch (const InputError& e) {
      throw InputError(fmt::format("{}:{}: error: {}", file.string(), number, e.what()));
    }
  }
  if (out.empty()) throw InputError(fmt::format("{} names no station", file.string()));
  return out;
}

}  // namespace insula::gateway
