// SPDX-License-Identifier: GPL-3.0-or-later
// Requests of an overview: what this station says of itself, and what this gateway has heard of other stations.
#include <fmt/format.h>

#include <charconv>

#include "viewer/gateway/http_session.h"

namespace insula::gateway {
namespace {

constexpr std::string_view json_type = "application/json", jpeg_type = "image/jpeg";

/// The number of a station in a query; nothing if there is no such station.
std::optional<std::size_t> station_in(std::string_view target, const Room& room) {
  const std::size_t mark = target.find('?');
  const std::string text = query_value(mark == target.npos ? "" : target.substr(mark + 1), "station");
  std::size_t out = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), out);
  const bool good = error == std::errc() && end == text.data() + text.size() && !text.empty() && room.has(out);
  return good ? std::optional(out) : std::nullopt;
}

}  // namespace

/// /api/station, /api/station/picture, /api/ticket, /api/room, /api/room/picture, /api/room/open, /api/room/stations,
/// /api/room/access. Only for who may give commands, and from our own site where something changes.
void HttpSession::answer_room(const Request& request, const std::vector<std::string>& parts) {
  const auto refuse = [&](http::status status, std::string_view why) { send_error(request, status, why); };
  const bool reads = request.method() == http::verb::get || request.method() == http::verb::head;
  if (visitor_.access < Access::instructor) return refuse(http::status::forbidden, "only for instructors");
  if (!reads && !same_site(request)) return refuse(http::status::forbidden, "foreign origin");
  const std::string part = parts.size() == 3 ? parts[2] : parts.size() == 2 ? "" : "?";
  const auto picture = [&](const std::string& jpeg) {
    if (jpeg.empty()) return refuse(http::status::not_found, "no picture");
    send_text(request, http::status::ok, jpeg_type, jpeg);
  };
  if (parts[1] == "station" && part.empty() && reads) {
    site_.hub.want_picture(Station::Clock::now());
    return send_text(request, http::status::ok, json_type, site_.station.json(Station::Clock::now()));
  }
  if (parts[1] == "station" && part == "picture")
    return reads ? picture(site_.station.picture()) : take_picture(request);
  if (parts[1] == "ticket" && part.empty() && !reads) return give_ticket(request);
  if (parts[1] == "room" && part.empty() && reads)
    return send_text(request, http::status::ok, json_type, site_.room.json());
  const std::string_view target(request.target().data(), request.target().size());
  if (parts[1] == "room" && part == "stations" && !reads) return change_room(request);
  if (parts[1] == "room" && part == "access") return answer_access(request);
  const auto station = station_in(target, site_.room);
  if (parts[1] != "room" || !station) return refuse(http::status::not_found, "not found");
  if (part == "picture" && reads) return picture(site_.room.picture(*station));
  if (part != "open" || reads) return refuse(http::status::not_found, "not found");
  site_.audit.write({visitor_.address,
                     std::string(name_of(visitor_.access)),
                     0,
                     "open " + std::string(target),
                     true,
                     {},
                     visitor_.who});
  site_.room.open(*station, [self = shared_from_this(), request](const std::string& url) {
    self->send_text(request, http::status::ok, json_type, fmt::format("{{\"url\": \"{}\"}}\n", url));
  });
}

/// POST adds a station, and DELETE takes one off. The key of the room is shown to what is added, so only pages on this
/// machine may do it.
void HttpSession::change_room(const Request& request) {
  const auto refuse = [&](http::status status, std::string_view why) { send_error(request, status, why); };
  if (visitor_.access != Access::here) return refuse(http::status::forbidden, "only for pages on this machine");
  const std::string_view target(request.target().data(), request.target().size());
  const auto station = station_in(target, site_.room);
  const bool adds = request.method() == http::verb::post;
  if (!adds && request.method() != http::verb::delete_) return refuse(http::status::bad_request, "POST or DELETE");
  if (!adds && !station) return refuse(http::status::not_found, "there is no such station");
  const std::string why = adds ? site_.room.add(request.body()) : site_.room.remove(*station);
  site_.audit.write({visitor_.address, std::string(name_of(visitor_.access)), 0,
                     adds ? "add a station " + request.body() : "remove a station " + std::string(target), why.empty(),
                     why});
  if (!why.empty()) return refuse(http::status::bad_request, why);
  send_text(request, http::status::ok, json_type, "{}\n");
}

/// GET and POST. The secrets of the room do not leave this machine, and they are not in the record.
void HttpSession::answer_access(const Request& request) {
  const auto refuse = [&](http::status status, std::string_view why) { send_error(request, status, why); };
  if (visitor_.access != Access::here) return refuse(http::status::forbidden, "only for pages on this machine");
  if (request.method() == http::verb::get)
    return send_text(request, http::status::ok, json_type, site_.room_access.state().json);
  if (request.method() != http::verb::post) return refuse(http::status::bad_request, "GET or POST");
  const ApiAnswer answer = site_.room_access.change(request.body());
  site_.audit.write({visitor_.address, std::string(name_of(visitor_.access)), 0, "secrets of the room",
                     answer.status == 200, answer.status == 200 ? "" : answer.json});
  send_text(request, http::status(answer.status), json_type, answer.json);
}

/// Of the trainee's page, which is on this machine.
void HttpSession::take_picture(const Request& request) {
  const bool jpeg = request[http::field::content_type] == "image/jpeg";
  const auto refuse = [&](http::status status, std::string_view why) { send_error(request, status, why); };
  if (visitor_.access != Access::here) return refuse(http::status::forbidden, "only for pages on this machine");
  if (request.method() != http::verb::put || !jpeg) return refuse(http::status::bad_request, "PUT an image/jpeg");
  const std::string_view why = site_.station.set_picture(request.body());
  if (!why.empty()) return refuse(http::status::bad_request, why);
  send_text(request, http::status::ok, json_type, "{}\n");
}

void HttpSession::give_ticket(const Request& request) {
  if (!site_.logins.needed()) return send_error(request, http::status::not_found, "no logins here");
  site_.audit.write({visitor_.address, std::string(name_of(visitor_.access)), 0, "ticket", true, {}, visitor_.who});
  send_text(request, http::status::ok, json_type, fmt::format("{{\"ticket\": \"{}\"}}\n", site_.logins.ticket()));
}

}  // namespace insula::gateway
