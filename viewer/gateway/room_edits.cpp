// SPDX-License-Identifier: GPL-3.0-or-later
// The stations of a room that were added on the page. They are kept in a file of the gateway's own.
#include <nlohmann/json.hpp>

#include <algorithm>
#include <fstream>

#include "core/base/input_error.h"
#include "viewer/gateway/replace_file.h"
#include "viewer/gateway/room.h"

namespace insula::gateway {
namespace {

using Kept = nlohmann::ordered_json;

std::string text_of(const Kept& json, const char* name) {
  return json.is_object() && json.contains(name) && json[name].is_string() ? json[name].get<std::string>()
                                                                           : std::string();
}

StationAddress station_from(const Kept& json) {
  return station_of(text_of(json, "name"), text_of(json, "url"), text_of(json, "fingerprint"));
}

}  // namespace

std::string Room::add(const std::string& text) {
  if (kept_.empty()) return "this gateway has no folder of its own to keep the list in";
  if (stations_.size() >= most_stations) return "the room is full";
  StationAddress address;
  try {
    address = station_from(Kept::parse(text, nullptr, false));
  } catch (const InputError& e) {
    return e.what();
  }
  if (is_listed(address)) return "a station with this address is listed already";
  for (const auto& entry : stations_)
    if (entry->address.name == address.name) return "a station with this name is listed already";
  list(std::move(address), false);
  if (std::string why = keep(); !why.empty()) {
    stations_.pop_back();
    return why;
  }
  ask(stations_.back());
  return {};
}

std::string Room::remove(std::size_t station) {
  const auto place =
      std::find_if(stations_.begin(), stations_.end(), [&](const auto& entry) { return entry->number == station; });
  if (place == stations_.end()) return "there is no such station";
  if ((*place)->given) return "this station is in the list that the gateway was started with";
  const auto taken = *place;
  const auto at = stations_.erase(place);
  std::string why = keep();
  if (!why.empty()) stations_.insert(at, taken);
  return why;
}

/// Replaces the file in one go, so that a crash leaves the old list or the new one.
std::string Room::keep() const {
  Kept out = Kept::array();
  for (const auto& entry : stations_)
    if (!entry->given)
      out.push_back(
          {{"name", entry->address.name}, {"url", entry->address.url()}, {"fingerprint", entry->address.fingerprint}});
  return replace_file(kept_, out.dump(1) + "\n") ? "" : "the list cannot be written";
}

void Room::read_kept() {
  if (kept_.empty() || !std::filesystem::exists(kept_)) return;
  std::ifstream in(kept_, std::ios::binary);
  const Kept list_kept = Kept::parse(in, nullptr, false);
  if (!list_kept.is_array()) throw InputError(kept_.string() + " is no list of stations");
  for (const Kept& each : list_kept) {
    if (stations_.size() >= most_stations) break;
    StationAddress address = station_from(each);
    if (!is_listed(address)) list(std::move(address), false);
  }
}

}  // namespace insula::gateway
