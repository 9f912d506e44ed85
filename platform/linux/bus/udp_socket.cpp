// SPDX-License-Identifier: GPL-3.0-or-later
// Multicast sockets on Linux.
#include "core/bus/udp_socket.h"

#include <arpa/inet.h>
#include <fcntl.h>
#include <linux/filter.h>
#include <linux/if_packet.h>
#include <net/if.h>
#include <netinet/in.h>
#include <poll.h>
#include <sys/socket.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <cstring>

namespace insula {
namespace {

sockaddr_in socket_address(const UdpmAddress& address) {
  sockaddr_in out{};
  out.sin_family = AF_INET;
  out.sin_port = htons(address.port);
  std::memcpy(&out.sin_addr, address.group.data(), address.group.size());
  return out;
}

unsigned loopback_index() {
  const unsigned found = ::if_nametoindex("lo");
  return found != 0 ? found : 1;  // Linux gives the loopback interface index 1 in every network namespace
}

template <class T>
bool set_option(int socket, int level, int name, const T& value) {
  return ::setsockopt(socket, level, name, &value, sizeof value) == 0;
}

/// Accepts datagrams of the loopback interface, and the kernel's copies of this machine's own multicast datagrams
/// (PACKET_LOOPBACK, which no network device can set). Everything else is dropped before it is queued.
bool accept_this_machine_only(int socket) {
  constexpr auto ancillary = [](int field) { return std::uint32_t(SKF_AD_OFF + field); };
  std::array<sock_filter, 6> code{{
      BPF_STMT(BPF_LD | BPF_W | BPF_ABS, ancillary(SKF_AD_PKTTYPE)),
      BPF_JUMP(BPF_JMP | BPF_JEQ | BPF_K, PACKET_LOOPBACK, 3, 0),
      BPF_STMT(BPF_LD | BPF_W | BPF_ABS, ancillary(SKF_AD_IFINDEX)),
      BPF_JUMP(BPF_JMP | BPF_JEQ | BPF_K, loopback_index(), 1, 0),
      BPF_STMT(BPF_RET | BPF_K, 0),
      BPF_STMT(BPF_RET | BPF_K, 0xFFFFFFFF),
  }};
  const sock_fprog program{code.size(), code.data()};
  return set_option(socket, SOL_SOCKET, SO_ATTACH_FILTER, program);
}

bool has_route(const UdpmAddress& address) {
  const int probe = ::socket(AF_INET, SOCK_DGRAM | SOCK_CLOEXEC, 0);
  const sockaddr_in group = socket_address(address);
  const bool ok = probe >= 0 && ::connect(probe, reinterpret_cast<const sockaddr*>(&group), sizeof group) == 0;
  if (probe >= 0) ::close(probe);
  return ok;
}

}  // namespace

UdpSender::UdpSender(const UdpmAddress& address) : address_(address) {
  socket_ = ::socket(AF_INET, SOCK_DGRAM | SOCK_CLOEXEC, 0);
  const int ttl = address.ttl, loop = 1;
  if (socket_ < 0 || !set_option(socket_, IPPROTO_IP, IP_MULTICAST_TTL, ttl) ||
      !set_option(socket_, IPPROTO_IP, IP_MULTICAST_LOOP, loop) || (!has_route(address) && !use_loopback()))
    error_ = std::strerror(errno);
}

UdpSender::~UdpSender() {
  if (socket_ >= 0) ::close(socket_);
}

bool UdpSender::use_loopback() {
  ip_mreqn by{};
  by.imr_ifindex = int(loopback_index());
  return on_loopback_ = set_option(socket_, IPPROTO_IP, IP_MULTICAST_IF, by);
}

bool UdpSender::send(std::span<const std::uint8_t> head, std::span<const std::uint8_t> payload) {
  sockaddr_in to = socket_address(address_);
  std::array<iovec, 2> pieces{iovec{const_cast<std::uint8_t*>(head.data()), head.size()},
                              iovec{const_cast<std::uint8_t*>(payload.data()), payload.size()}};
  msghdr message{};
  message.msg_name = &to;
  message.msg_namelen = sizeof to;
  message.msg_iov = pieces.data();
  message.msg_iovlen = pieces.size();
  const auto sent = [&] {
    ssize_t n;
    do n = ::sendmsg(socket_, &message, 0);
    while (n < 0 && errno == EINTR);
    return n >= 0;
  };
  bool ok = sent();
  const bool route_gone =
      !ok && (errno == ENETUNREACH || errno == ENETDOWN || errno == EADDRNOTAVAIL || errno == ENODEV);
  if (route_gone && !on_loopback_) ok = use_loopback() && sent();
  error_ = ok ? "" : std::strerror(errno);
  return ok;
}

UdpReceiver::UdpReceiver(const UdpmAddress& address) {
  if (const char* failed = open(address); failed != nullptr) error_ = std::string(failed) + ": " + std::strerror(errno);
}

const char* UdpReceiver::open(const UdpmAddress& address) {
  std::array<int, 2> pipe{};
  if (::pipe2(pipe.data(), O_CLOEXEC | O_NONBLOCK) != 0) return "pipe";
  wake_read_ = pipe[0];
  wake_write_ = pipe[1];
  socket_ = ::socket(AF_INET, SOCK_DGRAM | SOCK_CLOEXEC | SOCK_NONBLOCK, 0);
  if (socket_ < 0) return "socket";
  // The filter is set before the port and the group, so that no datagram of another machine is queued.
  const bool filtered = accept_this_machine_only(socket_);
  const int on = 1, off = 0, bytes = address.receive_buffer_bytes;
  if (!set_option(socket_, SOL_SOCKET, SO_REUSEADDR, on)) return "SO_REUSEADDR";
  if (!set_option(socket_, IPPROTO_IP, IP_MULTICAST_ALL, off)) return "IP_MULTICAST_ALL";
  if (bytes > 0) set_option(socket_, SOL_SOCKET, SO_RCVBUF, bytes);  // the kernel may grant less
  const sockaddr_in group = socket_address(address);                 // datagrams to a single host are not received
  if (::bind(socket_, reinterpret_cast<const sockaddr*>(&group), sizeof group) != 0) return "bind";
  return join(address, filtered) ? nullptr : "IP_ADD_MEMBERSHIP";
}

UdpReceiver::~UdpReceiver() {
  for (const int descriptor : {socket_, wake_read_, wake_write_})
    if (descriptor >= 0) ::close(descriptor);
}

/// Joins on the loopback interface, and on the interface of the machine's route to the group, which LCM's tools use.
bool UdpReceiver::join(const UdpmAddress& address, bool filtered) {
  ip_mreqn by{};
  by.imr_multiaddr = socket_address(address).sin_addr;
  if (filtered) set_option(socket_, IPPROTO_IP, IP_ADD_MEMBERSHIP, by);  // fails if there is no route
  by.imr_ifindex = int(loopback_index());
  return set_option(socket_, IPPROTO_IP, IP_ADD_MEMBERSHIP, by) ||
         errno == EADDRINUSE;  // the route may be that of the loopback interface
}

std::size_t UdpReceiver::receive(std::span<std::uint8_t> buffer, std::uint64_t& sender) {
  std::array<pollfd, 2> wait{pollfd{socket_, POLLIN, 0}, pollfd{wake_read_, POLLIN, 0}};
  while (!woken_.load(std::memory_order_relaxed)) {
    sockaddr_in from{};
    socklen_t from_bytes = sizeof from;
    const ssize_t got =
        ::recvfrom(socket_, buffer.data(), buffer.size(), 0, reinterpret_cast<sockaddr*>(&from), &from_bytes);
    if (got > 0) {
      sender = std::uint64_t(ntohl(from.sin_addr.s_addr)) << 16 | ntohs(from.sin_port);
      return std::size_t(got);
    }
    if (got < 0 && errno != EINTR) ::poll(wait.data(), wait.size(), -1);
  }
  return 0;
}

void UdpReceiver::wake() {
  woken_ = true;
  const char byte = 0;
  [[maybe_unused]] const ssize_t ignored = ::write(wake_write_, &byte, 1);
}

}  // namespace insula
