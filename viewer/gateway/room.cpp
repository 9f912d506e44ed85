// SPDX-License-Identifier: GPL-3.0-or-later
#include "viewer/gateway/room.h"

#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>
#include <utility>

#include "viewer/gateway/station.h"

namespace insula::gateway {
namespace {

using Ordered = nlohmann::ordered_json;
using Clock = std::chrono::steady_clock;
namespace http = boost::beast::http;

const std::string none;

std::string why_not(const StationAnswer& answer) {
  if (answer.status == 0) return answer.error;
  if (answer.status == 401 || answer.status == 403) return "it does not admit this room's key";
  if (answer.status == 421) return "it does not answer to this name: start it with --host";
  return fmt::format("it answered with status {}", answer.status);
}

/// Empty if it is none: 64 hexadecimal digits.
std::string ticket_in(const StationAnswer& answer) {
  const Ordered json = Ordered::parse(answer.body, nullptr, false);
  if (answer.status != 200 || !json.is_object() || !json.contains("ticket") || !json["ticket"].is_string()) return {};
  const std::string ticket = json["ticket"];
  return ticket.size() == 64 && ticket.find_first_not_of("0123456789abcdef") == ticket.npos ? ticket : none;
}

}  // namespace

Room::Room(boost::asio::io_context& io, Lists lists, std::string key, ServiceDiscovery* discovery)
    : io_(io), timer_(io), kept_(std::move(lists.kept)), key_(std::move(key)), discovery_(discovery) {
  for (StationAddress& address : lists.given) list(std::move(address), true);
  read_kept();
}

void Room::list(StationAddress address, bool given) {
  const auto entry = std::make_shared<Entry>();
  entry->address = std::move(address);
  entry->given = given;
  entry->number = next_number_++;
  stations_.push_back(entry);
}

Room::EntryPtr Room::find(std::size_t station) const {
  for (const EntryPtr& entry : stations_)
    if (entry->number == station) return entry;
  return nullptr;
}

void Room::start() { ask_again(); }

void Room::ask_all() {
  for (const EntryPtr& entry : stations_)
    if (!entry->asking) ask(entry);
}

void Room::ask_again() {
  timer_.expires_after(period);
  timer_.async_wait([this](boost::system::error_code error) {
    if (error) return;
    if (Clock::now() - looked_ < nobody_looks) ask_all();
    ask_again();
  });
}

void Room::ask(const EntryPtr& entry) {
  entry->asking = true;
  ask_station(io_, entry->address, {http::verb::get, "/api/station", key_},
              [this, entry](StationAnswer answer) { heard(entry, std::move(answer)); });
}

void Room::heard(const EntryPtr& entry, StationAnswer answer) {
  entry->asking = false;
  const Ordered said = Ordered::parse(answer.body, nullptr, false);
  const bool good = answer.status == 200 && said.is_object();
  entry->error = good ? "" : answer.status == 200 ? "it is no station of Insula" : why_not(answer);
  if (!good) return;
  entry->said = answer.body;
  const std::uint64_t number =
      said.contains("picture") && said["picture"].is_number_unsigned() ? said["picture"].get<std::uint64_t>() : 0;
  if (number != entry->picture_number) ask_picture(entry, number);
}

void Room::ask_picture(const EntryPtr& entry, std::uint64_t number) {
  entry->asking = true;
  ask_station(io_, entry->address, {http::verb::get, "/api/station/picture", key_},
              [entry, number](StationAnswer answer) {
                entry->asking = false;
                if (answer.status != 200 || answer.body.size() > Station::most_picture_bytes ||
                    !is_jpeg(answer.body, Station::most_picture_px))
                  return;
                entry->picture = std::move(answer.body);
                entry->picture_number = number;
              });
}

bool Room::is_listed(const StationAddress& address) const {
  return std::any_of(stations_.begin(), stations_.end(),
                     [&](const EntryPtr& entry) { return entry->address.host_and_port() == address.host_and_port(); });
}

std::string Room::json() {
  const bool first = Clock::now() - std::exchange(looked_, Clock::now()) >= nobody_looks;
  if (first) ask_all();
  Ordered out{{"stations", Ordered::array()}, {"found", Ordered::array()}};
  out["search_error"] = discovery_ ? discovery_->browse() : "it is switched off";
  for (const EntryPtr& entry : stations_)
    out["stations"].push_back(
        {{"number", entry->number},
         {"name", entry->address.name},
         {"url", entry->address.url()},
         {"given", entry->given},
         {"error", entry->error},
         {"picture", entry->picture_number},
         {"station", entry->said.empty() ? Ordered() : Ordered::parse(entry->said, nullptr, false)}});
  if (discovery_)
    for (const StationAddress& found : discovery_->found())
      if (!is_listed(found)) out["found"].push_back({{"name", found.name}, {"url", found.url()}});
  return out.dump(-1, ' ', false, Ordered::error_handler_t::replace) + "\n";
}

const std::string& Room::picture(std::size_t station) const {
  const EntryPtr entry = find(station);
  return entry ? entry->picture : none;
}

void Room::open(std::size_t station, std::function<void(std::string url)> done) {
  const StationAddress& address = find(station)->address;
  ask_station(io_, address, {http::verb::post, "/api/ticket", key_},
              [url = address.url(), done = std::move(done)](const StationAnswer& answer) {
                const std::string ticket = ticket_in(answer);
                done(ticket.empty() ? url + "?role=instructor"
                                    : url + "login.html?next=%2Findex.html%3Frole%3Dinstructor#ticket=" + ticket);
              });
}

}  // namespace insula::gateway
