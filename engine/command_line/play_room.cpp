// SPDX-License-Identifier: GPL-3.0-or-later
#include "engine/command_line/play_room.h"

#include <fmt/format.h>

#include <fstream>

#include "core/base/input_error.h"
#include "core/base/pin.h"
#include "training/store/data_folder.h"

namespace insula {
namespace fs = std::filesystem;
namespace {

constexpr const char* random_pin = "random";

}  // namespace

void add_room_options(CLI::App& command, RoomOptions& o) {
  command.add_flag(std::string("--pin{") + random_pin + "}", o.pin,
                   "other machines log in with a PIN, which is printed; --pin=123456 gives one of 6 to 12 digits");
  auto* certificate = command.add_option("--certificate", o.certificate, "PEM file: pages are served by TLS");
  command.add_option("--key", o.key, "PEM file: private key of the certificate")->needs(certificate);
  command.add_flag("--tls", o.tls, "pages are served by TLS with a certificate that is made here")
      ->excludes(certificate);
  command.add_option("--room-key", o.room_key, "file with a key, readable by its owner alone, that programs show");
  command.add_flag("!--no-mdns", o.discovery, "neither announces this station in the network nor looks for others");
  command.add_option("--station", o.station, "name of this station in overviews; default: the machine's");
  command.add_option("--stations", o.stations, "file of the room's stations, for the overview: NAME URL [SHA-256]");
}

fs::path write_pins(const RoomOptions& options, const fs::path& folder,
                    const std::function<void(std::string_view)>& print) {
  if (options.pin.empty()) return {};
  const std::string pin = options.pin == random_pin ? new_pin() : options.pin;
  if (!is_pin(pin)) throw InputError("--pin: a PIN has 6 to 12 digits, as in --pin=123456");
  const std::string observer_pin = new_pin(pin);
  const fs::path file = folder / "pins.json";
  std::ofstream out(file);
  std::error_code error;
  fs::permissions(file, fs::perms::owner_read | fs::perms::owner_write, error);
  out << fmt::format("{{\"pin\": \"{}\", \"observer_pin\": \"{}\"}}\n", pin, observer_pin);
  out.close();
  if (!out || error || folder.empty()) throw InputError("the PIN cannot be kept: no folder can be written to");
  print(fmt::format("insula: PIN of instructors {}, PIN of observers {}", pin, observer_pin));
  return file;
}

std::vector<std::string> room_arguments(const RoomOptions& o, const fs::path& pins, const fs::path& data) {
  std::vector<std::string> out{"--own", training::data_folder(data).root.string()};
  const auto add = [&](const char* name, const std::string& value) {
    if (!value.empty()) out.insert(out.end(), {name, value});
  };
  add("--pins", pins.string());
  add("--room-key", o.room_key.string());
  add("--station", o.station);
  add("--stations", o.stations.string());
  add("--certificate", o.certificate.string());
  add("--key", o.key.string());
  if (o.tls) out.emplace_back("--tls");
  if (!o.discovery) out.emplace_back("--no-mdns");
  return out;
}

}  // namespace insula
