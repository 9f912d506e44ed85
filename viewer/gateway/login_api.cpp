// SPDX-License-Identifier: GPL-3.0-or-later
#include "viewer/gateway/login_api.h"

#include <fmt/format.h>

#include <nlohmann/json.hpp>

namespace insula::gateway {
namespace {

using Json = nlohmann::json;

std::string json_line(const Json& json) { return json.dump() + "\n"; }

std::string field(const Json& body, const char* name) {
  return body.contains(name) && body[name].is_string() ? body[name].get<std::string>() : std::string();
}

/// The value of a name in a Cookie field; empty if it is not there.
std::string cookie_value(std::string_view cookies, std::string_view name) {
  while (!cookies.empty()) {
    const std::size_t end = std::min(cookies.find(';'), cookies.size());
    std::string_view one = cookies.substr(0, end);
    cookies.remove_prefix(std::min(end + 1, cookies.size()));
    while (one.starts_with(' ')) one.remove_prefix(1);
    if (one.starts_with(name) && one.size() > name.size() && one[name.size()] == '=')
      return std::string(one.substr(name.size() + 1));
  }
  return {};
}

}  // namespace

void LoginApi::set_place(std::uint16_t port, bool encrypted) {
  cookie_ = fmt::format("insula_{}", port);
  encrypted_ = encrypted;
}

Credentials LoginApi::credentials(std::string_view cookie, std::string_view authorization) const {
  constexpr std::string_view bearer = "Bearer ";
  return {cookie_value(cookie, cookie_),
          authorization.starts_with(bearer) ? std::string(authorization.substr(bearer.size())) : std::string()};
}

Access LoginApi::access_of(const Credentials& credentials, const std::string& address) {
  if (!logins_.needed()) return Access::observer;
  if (credentials.key.empty()) return logins_.access_of(credentials.token);
  const Logins::Outcome outcome = logins_.access_of_key(credentials.key, address);
  if (!outcome.why.empty() && refused_lines_.take(RateLimit::Clock::now()))
    audit_.write({address, "program", 0, "key", false, outcome.why, "no login"});
  return outcome.access;
}

std::string LoginApi::who(const Credentials& credentials) {
  return credentials.key.empty() ? logins_.who(credentials.token) : "key of the room";
}

std::string LoginApi::state(Access access) const {
  return json_line({{"access", name_of(access)}, {"needed", logins_.needed()}});
}

LoginApi::Answer LoginApi::log_in(const std::string& text, const std::string& address) {
  const Json body = Json::parse(text, nullptr, false);
  const std::string pin = body.is_object() ? field(body, "pin") : "";
  const std::string ticket = body.is_object() ? field(body, "ticket") : "";
  if (pin.empty() == ticket.empty()) return {400, json_line({{"error", "give a pin or a ticket"}}), {}};
  const Logins::Outcome outcome =
      ticket.empty() ? logins_.log_in(pin, address, field(body, "name")) : logins_.redeem(ticket, address);
  const bool accepted = outcome.access != Access::none;
  if (accepted || refused_lines_.take(RateLimit::Clock::now()))
    audit_.write({address, std::string(name_of(outcome.access)), 0, "log in", accepted, outcome.why,
                  accepted ? outcome.who : "no login"});
  if (!accepted) return {outcome.too_many ? 429 : 401, json_line({{"error", outcome.why}}), {}};
  constexpr auto seconds = std::chrono::seconds(Logins::lasts).count();
  return {200, state(outcome.access),
          fmt::format("{}={}; Path=/; Max-Age={}; HttpOnly; SameSite=Strict{}", cookie_, outcome.token, seconds,
                      encrypted_ ? "; Secure" : "")};
}

LoginApi::Answer LoginApi::log_out(const Credentials& credentials) {
  logins_.log_out(credentials.token);
  return {200, state(Access::none), fmt::format("{}=; Path=/; Max-Age=0; HttpOnly; SameSite=Strict", cookie_)};
}

}  // namespace insula::gateway
