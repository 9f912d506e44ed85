// SPDX-License-Identifier: GPL-3.0-or-later
// Access to the gateway: the host names that it accepts, and the messages that a page of each role may send.
#pragma once
#include <boost/asio/ip/address.hpp>
#include <cstdint>
#include <functional>
#include <string>
#include <string_view>
#include <vector>

namespace insula::gateway {

/// The name in a Host field or an origin without its port, in lower case and without a final dot; an IPv6 address
/// without brackets, in its usual form. Empty when the text is malformed.
std::string host_name(std::string_view host);

/// The accepted host names: those of the loopback interface, the local address of a connection, and the given names. If
/// a foreign DNS server maps another name to this machine, pages of that name are refused (DNS rebinding).
class AllowedHosts {
 public:
  /// Whether a text is a valid name or address, without a scheme.
  static bool is_name(const std::string& given);
  explicit AllowedHosts(const std::vector<std::string>& given);

  /// Whether a request with this Host field may be answered. `reached` is the local address of its connection.
  bool allows(std::string_view host, const boost::asio::ip::address& reached) const;

 private:
  std::vector<std::string> given_;
};

/// Whether the ends of a connection are both on this machine.
using IsHere = std::function<bool(const boost::asio::ip::address& remote, const boost::asio::ip::address& local)>;
bool same_machine(const boost::asio::ip::address& remote, const boost::asio::ip::address& local);

/// What a request may do at most: that of its machine, or of its login (logins.h). In rising order.
enum class Access { none, observer, instructor, here };
std::string_view name_of(Access access);

/// Role of a page. The page chooses it when it connects ("/ws?role=observer"), within what its access admits.
enum class Role { trainee, instructor, observer };

/// The role in the query of a request target, or trainee if there is none. An unknown role is an observer.
Role role_of(std::string_view target);
std::string_view name_of(Role role);

struct Rights {
  bool hands = false;     ///< may send HAND_INPUT
  bool commands = false;  ///< may send USER_COMMAND
  bool speaks = false;    ///< may write to the others
  bool draws = false;     ///< may draw and point on the others' pictures
};

/// Trainees move hands and give commands, instructors give commands and draw, observers only watch. Only pages on this
/// machine may move hands. Pages of other machines do no more than their login admits.
Rights rights_of(Role role, Access access);

/// Who asks for something.
struct Visitor {
  std::string address;  ///< of the machine
  Access access = Access::none;
  Role role = Role::observer;
  std::uint64_t page = 0;  ///< its number, once it is connected; 0: a request
  std::string who = {};    ///< the login; empty: a page on this machine
  Rights rights() const { return rights_of(role, access); }
};

}  // namespace insula::gateway
