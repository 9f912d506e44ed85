// SPDX-License-Identifier: GPL-3.0-or-later
#include "viewer/gateway/room.h"

#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "viewer/gateway/station.h"

namespace insula::gateway {
namespace {

using Ordered = nlohmann::ordered_json;
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

Room::Room(boost::asio::io_context& io, std::vector<StationAddress> stations, std::string key)
    : io_(io), timer_(io), key_(std::move(key)) {
  for (StationAddress& address : stations) stations_.emplace_back().address = std::move(address);
}

void Room::start() {
  if (!stations_.empty()) ask_all();
}

void Room::ask_all() {
  for (Entry& entry : stations_)
    if (!entry.asking) ask(entry);
  timer_.expires_after(period);
  timer_.async_wait([this](boost::system::error_code error) {
    if (!error) ask_all();
  });
}

void Room::ask(Entry& entry) {
  entry.asking = true;
  ask_station(io_, entry.address, {http::verb::get, "/api/station", key_},
              [this, &entry](StationAnswer answer) { heard(entry, std::move(answer)); });
}

void Room::heard(Entry& entry, StationAnswer answer) {
  entry.asking = false;
  const Ordered said = Ordered::parse(answer.body, nullptr, false);
  const bool good = answer.status == 200 && said.is_object();
  entry.error = good ? "" : answer.status == 200 ? "it is no station of Insula" : why_not(answer);
  if (!good) return;
  entry.said = answer.body;
  const std::uint64_t number =
      said.contains("picture") && said["picture"].is_number_unsigned() ? said["picture"].get<std::uint64_t>() : 0;
  if (number != entry.picture_number) ask_picture(entry, number);
}

void Room::ask_picture(Entry& entry, std::uint64_t number) {
  entry.asking = true;
  ask_station(io_, entry.address, {http::verb::get, "/api/station/picture", key_},
              [&entry, number](StationAnswer answer) {
                entry.asking = false;
                if (answer.status != 200 || answer.body.size() > Station::most_picture_bytes ||
                    !is_jpeg(answer.body, Station::most_picture_px))
                  return;
                entry.picture = std::move(answer.body);
                entry.picture_number = number;
              });
}

std::string Room::json() const {
  Ordered out = Ordered::array();
  for (const Entry& entry : stations_)
    out.push_back({{"name", entry.address.name},
                   {"url", entry.address.url()},
                   {"error", entry.error},
                   {"picture", entry.picture_number},
                   {"station", entry.said.empty() ? Ordered() : Ordered::parse(entry.said, nullptr, false)}});
  return out.dump(-1, ' ', false, Ordered::error_handler_t::replace) + "\n";
}

const std::string& Room::picture(std::size_t station) const {
  return station < stations_.size() ? stations_[station].picture : none;
}

void Room::open(std::size_t station, std::function<void(std::string url)> done) {
  const StationAddress& address = stations_[station].address;
  ask_station(io_, address, {http::verb::post, "/api/ticket", key_},
              [url = address.url(), done = std::move(done)](const StationAnswer& answer) {
                const std::string ticket = ticket_in(answer);
                done(ticket.empty() ? url + "?role=instructor"
                                    : url + "login.html?next=%2Findex.html%3Frole%3Dinstructor#ticket=" + ticket);
              });
}

}  // namespace insula::gateway
