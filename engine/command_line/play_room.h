// SPDX-License-Identifier: GPL-3.0-or-later
// Options of `insula play` for a room with several machines: who is admitted, TLS, and the name of the station.
#pragma once
#include <CLI/CLI.hpp>
#include <filesystem>
#include <functional>
#include <string>
#include <string_view>
#include <vector>

namespace insula {

struct RoomOptions {
  std::string pin;   ///< of instructors; "random": drawn at the start; empty: other machines only observe
  bool tls = false;  ///< with a certificate that is made here
  std::filesystem::path certificate, key;  ///< given ones; empty: none
  std::filesystem::path room_key;          ///< file of the key that programs show; empty: none
  std::filesystem::path stations;          ///< list of the room's stations, for the overview; empty: none
  bool discovery = true;                   ///< announces the station where others reach it, and finds others
  std::string station;                     ///< its name in the overview; empty: the machine's
};

void add_room_options(CLI::App& command, RoomOptions& options);

/// Draws what is random, and writes the PINs to a file in `folder` that only its owner can read. Prints them. The file;
/// empty: there are no PINs. Throws InputError if a PIN is malformed or the file cannot be written.
std::filesystem::path write_pins(const RoomOptions& options, const std::filesystem::path& folder,
                                 const std::function<void(std::string_view)>& print);

/// Of the gateway. data: folder of the user's data.
std::vector<std::string> room_arguments(const RoomOptions& options, const std::filesystem::path& pins,
                                        const std::filesystem::path& data);

}  // namespace insula
