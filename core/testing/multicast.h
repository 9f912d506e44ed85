// SPDX-License-Identifier: GPL-3.0-or-later
// A separate bus for a test with real processes.
#pragma once
#include <netinet/in.h>
#include <sys/socket.h>
#include <unistd.h>

#include <cstdlib>
#include <string>

#include "core/bus/lcm_bus.h"

namespace insula::testing {

inline int free_udp_port() {
  const int s = ::socket(AF_INET, SOCK_DGRAM, 0);
  sockaddr_in address{};
  address.sin_family = AF_INET;
  socklen_t size = sizeof address;
  const bool ok = ::bind(s, reinterpret_cast<sockaddr*>(&address), size) == 0 &&
                  ::getsockname(s, reinterpret_cast<sockaddr*>(&address), &size) == 0;
  ::close(s);
  return ok ? ntohs(address.sin_port) : 7999;
}

inline std::string own_bus_url() { return "udpm://239.255.76.67:" + std::to_string(free_udp_port()) + "?ttl=0"; }

/// Whether messages of the bus return on this machine.
inline bool multicast_works() {
  LcmBus bus(own_bus_url());
  int seen = 0;
  bus.subscribe("PROBE", [&](Bytes) { ++seen; });
  for (int i = 0; i < 50 && bus.good() && seen == 0; ++i) {
    const std::uint8_t byte = 1;
    bus.publish("PROBE", Bytes(&byte, 1));
    bus.poll(20);
  }
  return seen > 0;
}

/// Whether LCM's own library and tools have the multicast route that they need. As root, this adds a missing route.
inline bool lcm_tools_work() {
  const auto has_route = [] {
    const int probe = ::socket(AF_INET, SOCK_DGRAM, 0);
    sockaddr_in to{};
    to.sin_family = AF_INET;
    to.sin_port = htons(7667);
    to.sin_addr.s_addr = htonl(0xEFFF4C43);  // 239.255.76.67
    const bool ok = ::connect(probe, reinterpret_cast<const sockaddr*>(&to), sizeof to) == 0;
    ::close(probe);
    return ok;
  };
  if (has_route()) return true;
  if (::geteuid() != 0) return false;
  [[maybe_unused]] const int status =
      std::system("(ip link set lo up multicast on && ip route add 224.0.0.0/4 dev lo) > /dev/null 2>&1");
  return has_route();
}

}  // namespace insula::testing
