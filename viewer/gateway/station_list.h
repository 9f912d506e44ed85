// SPDX-License-Identifier: GPL-3.0-or-later
// The stations of a room, from a file: a line for each, NAME URL [SHA-256 of its certificate]. "#" begins a comment.
#pragma once
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

namespace insula::gateway {

struct StationAddress {
  std::string name;
  std::string host;  ///< name or address, without brackets
  std::string port;
  bool encrypted = false;
  std::string fingerprint;  ///< "AB:CD:..." of its certificate; empty: one that the system trusts
  /// "https://host:port/"
  std::string url() const;
  /// For the field Host.
  std::string host_and_port() const;
};

inline constexpr std::size_t most_stations = 100;

/// From its words; fingerprint: empty: none. Throws InputError with what is wrong.
StationAddress station_of(std::string_view name, std::string_view url, std::string_view fingerprint);

/// Throws InputError with the line that is wrong.
std::vector<StationAddress> read_stations(const std::filesystem::path& file);

}  // namespace insula::gateway
