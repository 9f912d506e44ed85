// SPDX-License-Identifier: GPL-3.0-or-later
// The two sockets of an endpoint of the bus. One sends to a multicast group, the other receives what this machine sent
// to it. The implementation belongs to the operating system (platform/linux/bus/udp_socket.cpp).
#pragma once
#include <atomic>
#include <cstdint>
#include <span>
#include <string>

#include "core/bus/udpm_url.h"

namespace insula {

/// Sends datagrams to the group. They follow the machine's routes, as LCM's do, or use the loopback interface if there
/// is no route.
class UdpSender {
 public:
  explicit UdpSender(const UdpmAddress& address);
  ~UdpSender();
  UdpSender(const UdpSender&) = delete;
  UdpSender& operator=(const UdpSender&) = delete;

  /// Sends one datagram made of two pieces. False when the system refused it; error() then gives the reason. Not
  /// thread-safe.
  bool send(std::span<const std::uint8_t> head, std::span<const std::uint8_t> payload);
  const std::string& error() const { return error_; }  ///< empty if there is none

 private:
  bool use_loopback();

  UdpmAddress address_;
  int socket_ = -1;
  bool on_loopback_ = false;
  std::string error_;
};

/// Receives datagrams of the group that were sent on this machine. The kernel drops all others before they take space
/// in the receive buffer: a filter on the socket accepts datagrams of the loopback interface and datagrams that the
/// kernel looped back from a socket of this machine. If the kernel has no socket filters, only the loopback interface
/// is joined.
class UdpReceiver {
 public:
  explicit UdpReceiver(const UdpmAddress& address);
  ~UdpReceiver();
  UdpReceiver(const UdpReceiver&) = delete;
  UdpReceiver& operator=(const UdpReceiver&) = delete;

  const std::string& error() const { return error_; }  ///< empty if there is none
  /// Waits for a datagram and returns its size, at most the buffer's; 0 after wake(). `sender` tells senders apart.
  std::size_t receive(std::span<std::uint8_t> buffer, std::uint64_t& sender);
  /// Ends a waiting receive(), and every later one at once. May be called from any thread.
  void wake();

 private:
  const char* open(const UdpmAddress& address);  // returns the call that failed, or null
  bool join(const UdpmAddress& address, bool filtered);

  int socket_ = -1, wake_read_ = -1, wake_write_ = -1;
  std::atomic<bool> woken_{false};
  std::string error_;
};

}  // namespace insula
