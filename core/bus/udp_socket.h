// SPDX-License-Identifier: GPL-3.0-or-later
// The two sockets of an endpoint of the bus: one sends to a multicast group, one receives from it what this machine
// sent. The implementation belongs to the operating system (platform/linux/udp_socket.cpp).
#pragma once
#include <atomic>
#include <cstdint>
#include <span>
#include <string>

#include "core/bus/udpm_url.h"

namespace insula {

/// Sends datagrams to the group. They take the way of the machine's routes, as LCM's do, and the loopback interface
/// when there is no route.
class UdpSender {
 public:
  explicit UdpSender(const UdpmAddress& address);
  ~UdpSender();
  UdpSender(const UdpSender&) = delete;
  UdpSender& operator=(const UdpSender&) = delete;

  /// One datagram made of two pieces. False when the system refused it; error() then says why. Not for several threads.
  bool send(std::span<const std::uint8_t> head, std::span<const std::uint8_t> payload);
  const std::string& error() const { return error_; }  ///< empty when all is well

 private:
  bool use_loopback();

  UdpmAddress address_;
  int socket_ = -1;
  bool on_loopback_ = false;
  std::string error_;
};

/// Receives datagrams of the group that were sent on this machine. The kernel drops all others before they take space
/// in the receive buffer: a filter on the socket lets through what came over the loopback interface and what the kernel
/// itself looped back from a sending socket of this machine. Where the kernel knows no filters, only the loopback
/// interface is joined.
class UdpReceiver {
 public:
  explicit UdpReceiver(const UdpmAddress& address);
  ~UdpReceiver();
  UdpReceiver(const UdpReceiver&) = delete;
  UdpReceiver& operator=(const UdpReceiver&) = delete;

  const std::string& error() const { return error_; }  ///< empty when all is well
  /// Waits for a datagram and returns its size, at most the buffer's; 0 after wake(). `sender` tells senders apart.
  std::size_t receive(std::span<std::uint8_t> buffer, std::uint64_t& sender);
  /// Ends a waiting receive(), and every later one at once. From any thread.
  void wake();

 private:
  const char* open(const UdpmAddress& address);  // the call that failed, null when none did
  bool join(const UdpmAddress& address, bool filtered);

  int socket_ = -1, wake_read_ = -1, wake_write_ = -1;
  std::atomic<bool> woken_{false};
  std::string error_;
};

}  // namespace insula
