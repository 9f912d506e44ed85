// SPDX-License-Identifier: GPL-3.0-or-later
// Stations announce themselves in the network and overviews find them: DNS-based service discovery (RFC 6763) over
// multicast DNS (RFC 6762). Anybody in the network can announce anything. So what is found is checked, bounded in
// number and length, and nothing is ever sent to it from here.
#pragma once
#include <boost/asio/ip/address.hpp>
#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "viewer/gateway/station_list.h"

namespace insula::gateway {

/// What a station says of itself to everybody in the network.
struct Announcement {
  std::string name;                 ///< of the station; at most 63 bytes of it are used
  boost::asio::ip::address listen;  ///< where it listens; unspecified: all addresses of the machine
  std::uint16_t port = 0;
  bool encrypted = false;  ///< by TLS
};

/// The fields of a TXT record.
using ServiceFields = std::map<std::string, std::string>;

/// An announced station as one to be shown; nothing if it is none. It has a name of 1 to 63 bytes without control
/// characters, an address that other machines' browsers can use, a port, "tls" (0 or 1) and "path" ("/").
std::optional<StationAddress> read_service(const std::string& name, const boost::asio::ip::address& address,
                                           std::uint16_t port, const ServiceFields& fields);

/// What was heard of one station on one network by one protocol.
struct HeardStation {
  StationAddress address;
  std::string machine;  ///< name of the host that its announcement gives: each station has its own
};

/// Each station once, by name and then by address. One that was heard several times has its IPv4 address, which is the
/// shorter to read. Two of one name, which may be in two networks, stay two. At most `most`.
std::vector<StationAddress> distinct_stations(const std::vector<HeardStation>& heard, std::size_t most);

class ServiceDiscovery {
 public:
  static constexpr const char* type = "_insula._tcp";
  static constexpr std::size_t most_found = 64;

  ServiceDiscovery();
  ~ServiceDiscovery();  ///< takes the announcement back
  ServiceDiscovery(const ServiceDiscovery&) = delete;
  ServiceDiscovery& operator=(const ServiceDiscovery&) = delete;

  /// Announces a station from now on; once, and before browse(). A name that another station has gets a number. The
  /// error text; empty: it began.
  std::string announce(const Announcement& announcement);
  /// Looks for stations from now on. The error text; empty: it began, or it had begun before.
  std::string browse();
  /// The stations that are announced now, without the own one, by name.
  std::vector<StationAddress> found() const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace insula::gateway
