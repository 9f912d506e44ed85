// SPDX-License-Identifier: GPL-3.0-or-later
// Names, roles and rights.
#include "viewer/gateway/access.h"

#include <algorithm>

namespace asio = boost::asio;

namespace insula::gateway {
namespace {

bool is_port(std::string_view text) {
  const auto digit = [](char c) { return c >= '0' && c <= '9'; };
  return text.size() <= 5 && std::all_of(text.begin(), text.end(), digit);
}

/// The usual form of an address, so that [::0001] and [::1] are the same; empty when it is none.
std::string usual_form(std::string_view address) {
  boost::system::error_code error;
  const auto parsed = asio::ip::make_address(std::string(address), error);
  return error ? std::string() : parsed.to_string();
}

/// As host_name, and an IPv6 address may stand without brackets.
std::string given_name(const std::string& given) {
  const bool bare_v6 = std::count(given.begin(), given.end(), ':') > 1 && !given.starts_with('[');
  return host_name(bare_v6 ? "[" + given + "]" : given);
}

}  // namespace

std::string host_name(std::string_view host) {
  std::string_view name, port;
  if (host.starts_with('[')) {
    const std::size_t end = host.find(']');
    if (end == std::string_view::npos) return {};
    port = host.substr(end + 1);
    if (!port.empty() && port[0] != ':') return {};
    name = host.substr(1, end - 1);
    if (!port.empty()) port.remove_prefix(1);
    return is_port(port) && name.find(':') != std::string_view::npos ? usual_form(name) : std::string();
  }
  const std::size_t colon = host.find(':');
  name = host.substr(0, colon);
  if (colon != std::string_view::npos) port = host.substr(colon + 1);
  if (name.ends_with('.')) name.remove_suffix(1);
  const auto good = [](char c) {
    return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '.' || c == '-' ||
           c == '_';
  };
  if (!is_port(port) || name.size() > 253 || !std::all_of(name.begin(), name.end(), good)) return {};
  std::string out(name);
  for (char& c : out)
    if (c >= 'A' && c <= 'Z') c = char(c - 'A' + 'a');
  return out;
}

bool AllowedHosts::is_name(const std::string& given) { return !given_name(given).empty(); }

AllowedHosts::AllowedHosts(const std::vector<std::string>& given) {
  for (const std::string& name : given) given_.push_back(given_name(name));
}

bool AllowedHosts::allows(std::string_view host, const asio::ip::address& reached) const {
  const std::string name = host_name(host);
  if (name.empty()) return false;
  if (name == "localhost" || name == "127.0.0.1" || name == "::1") return true;
  const bool mapped = reached.is_v6() && reached.to_v6().is_v4_mapped();
  const std::string local =
      mapped ? asio::ip::make_address_v4(asio::ip::v4_mapped, reached.to_v6()).to_string() : reached.to_string();
  return name == local || std::find(given_.begin(), given_.end(), name) != given_.end();
}

Role role_of(std::string_view target) {
  const std::size_t mark = target.find('?');
  std::string_view query = mark == std::string_view::npos ? std::string_view() : target.substr(mark + 1);
  while (!query.empty()) {
    const std::size_t end = std::min(query.find('&'), query.size());
    const std::string_view part = query.substr(0, end);
    query.remove_prefix(std::min(end + 1, query.size()));
    if (!part.starts_with("role=")) continue;
    const std::string_view role = part.substr(5);
    return role == "trainee" ? Role::trainee : role == "instructor" ? Role::instructor : Role::observer;
  }
  return Role::trainee;
}

bool same_machine(const asio::ip::address& remote, const asio::ip::address& local) {
  return remote.is_loopback() || remote == local;
}

std::string_view name_of(Access access) {
  return access == Access::here         ? "here"
         : access == Access::instructor ? "instructor"
         : access == Access::observer   ? "observer"
                                        : "none";
}

std::string_view name_of(Role role) {
  return role == Role::trainee ? "trainee" : role == Role::instructor ? "instructor" : "observer";
}

Rights rights_of(Role role, Access access) {
  const bool trusted = access >= Access::instructor;
  const bool acts = trusted && role != Role::observer;
  return {role == Role::trainee && access == Access::here, acts, acts, trusted && role == Role::instructor};
}

}  // namespace insula::gateway
