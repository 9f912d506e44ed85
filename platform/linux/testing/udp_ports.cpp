// SPDX-License-Identifier: GPL-3.0-or-later
// Ports and routes by sockets.
#include "core/testing/udp_ports.h"

#include <netinet/in.h>
#include <sys/socket.h>
#include <unistd.h>

#include <cstdlib>

namespace insula::testing {
namespace {

bool has_route() {
  const int probe = ::socket(AF_INET, SOCK_DGRAM, 0);
  sockaddr_in to{};
  to.sin_family = AF_INET;
  to.sin_port = htons(7667);
  to.sin_addr.s_addr = htonl(0xEFFF4C43);  // 239.255.76.67
  const bool ok = ::connect(probe, reinterpret_cast<const sockaddr*>(&to), sizeof to) == 0;
  ::close(probe);
  return ok;
}

}  // namespace

int free_udp_port() {
  const int s = ::socket(AF_INET, SOCK_DGRAM, 0);
  sockaddr_in address{};
  address.sin_family = AF_INET;
  socklen_t size = sizeof address;
  const bool ok = ::bind(s, reinterpret_cast<sockaddr*>(&address), size) == 0 &&
                  ::getsockname(s, reinterpret_cast<sockaddr*>(&address), &size) == 0;
  ::close(s);
  return ok ? ntohs(address.sin_port) : 7999;
}

bool lcm_tools_work() {
  if (has_route()) return true;
  if (::geteuid() != 0) return false;
  [[maybe_unused]] const int status =
      std::system("(ip link set lo up multicast on && ip route add 224.0.0.0/4 dev lo) > /dev/null 2>&1");
  return has_route();
}

}  // namespace insula::testing
