// SPDX-License-Identifier: GPL-3.0-or-later
// Who may ask the gateway for what: the names it answers to, and what a page of each role may send.
#pragma once
#include <boost/asio/ip/address.hpp>
#include <string>
#include <string_view>
#include <vector>

namespace insula::gateway {

/// The name in a Host field or an origin without its port, in lower case and without a final dot; an IPv6 address
/// without brackets, in its usual form. Empty when the text is malformed.
std::string host_name(std::string_view host);

/// The names the gateway answers to: those of the loopback interface, the address a connection reached, and the names
/// that were given. A name that a foreign DNS server lets point to this machine is none of them, so pages of that name
/// are refused (DNS rebinding).
class AllowedHosts {
 public:
  /// Whether a text can be given: a name or an address, without a scheme.
  static bool is_name(const std::string& given);
  explicit AllowedHosts(const std::vector<std::string>& given);

  /// Whether a request with this Host field may be answered. `reached` is the local address of its connection.
  bool allows(std::string_view host, const boost::asio::ip::address& reached) const;

 private:
  std::vector<std::string> given_;
};

/// What a page may do. It chooses its role when it connects ("/ws?role=observer"); this keeps order in a training room
/// and is no lock.
enum class Role { trainee, instructor, observer };

/// The role in the query of a request target: trainee when there is none. An unknown role is an observer.
Role role_of(std::string_view target);

struct Rights {
  bool hands = false;     ///< may send HAND_INPUT
  bool commands = false;  ///< may send USER_COMMAND
};

/// Trainees move hands and give commands, instructors give commands, observers only watch. Hands are moved only by
/// pages on this machine: `here` says whether the page is one.
Rights rights_of(Role role, bool here);

}  // namespace insula::gateway
