// SPDX-License-Identifier: GPL-3.0-or-later
// Malformed datagrams, and a plain socket that sends them to the bus.
#pragma once
#include <arpa/inet.h>
#include <netinet/in.h>
#include <sys/socket.h>
#include <unistd.h>

#include <algorithm>
#include <cstring>
#include <random>
#include <string>
#include <vector>

#include "core/bus/channels.h"
#include "core/bus/udpm_url.h"

namespace insula::testing {

using Buffer = std::vector<std::uint8_t>;

/// A UDP socket of the calling thread's network namespace.
class PlainSender {
 public:
  explicit PlainSender(int ttl) : socket_(::socket(AF_INET, SOCK_DGRAM | SOCK_CLOEXEC, 0)) {
    ::setsockopt(socket_, IPPROTO_IP, IP_MULTICAST_TTL, &ttl, sizeof ttl);
  }
  ~PlainSender() { ::close(socket_); }
  PlainSender(const PlainSender&) = delete;
  PlainSender& operator=(const PlainSender&) = delete;

  bool send(const Buffer& datagram, const std::string& address, std::uint16_t port) const {
    sockaddr_in to{};
    to.sin_family = AF_INET;
    to.sin_port = htons(port);
    ::inet_pton(AF_INET, address.c_str(), &to.sin_addr);
    const auto* at = reinterpret_cast<const sockaddr*>(&to);
    return ::sendto(socket_, datagram.data(), datagram.size(), 0, at, sizeof to) == ssize_t(datagram.size());
  }

 private:
  int socket_;
};

inline void append32(Buffer& out, std::uint32_t value) {
  for (int shift = 24; shift >= 0; shift -= 8) out.push_back(std::uint8_t(value >> shift));
}

inline void append_name(Buffer& out, std::string_view name) {
  out.insert(out.end(), name.begin(), name.end());
  out.push_back(0);
}

struct FragmentHead {
  std::uint32_t sequence, size, offset;
  std::uint16_t number, fragments;
};

/// A fragment of LCM's protocol with any head. A channel's name follows in the first one.
inline Buffer fragment(const FragmentHead& head, std::string_view name, std::size_t bytes) {
  Buffer out;
  append32(out, 0x4C433033);
  append32(out, head.sequence);
  append32(out, head.size);
  append32(out, head.offset);
  append32(out, std::uint32_t(head.number) << 16 | head.fragments);
  if (head.number == 0) append_name(out, name);
  out.insert(out.end(), bytes, std::uint8_t(0xA5));
  return out;
}

/// A complete short message of LCM's protocol.
inline Buffer short_datagram(std::string_view channel, const Buffer& message) {
  Buffer out;
  append32(out, 0x4C433032);
  append32(out, 1);
  append_name(out, channel);
  out.insert(out.end(), message.begin(), message.end());
  return out;
}

/// Random malformed datagrams of the bus, the same for the same seed. Numbers are typical values of errors.
class MalformedDatagrams {
 public:
  explicit MalformedDatagrams(unsigned seed) : random_(seed) {}

  Buffer next() {
    const std::string_view name = names[below(names.size())];
    const std::size_t bytes = below(20) == 0 ? below(60'000) : below(1200);
    switch (below(8)) {
      case 0: return noise(below(200));
      case 1: {
        Buffer out = short_datagram(std::string(below(200), 'x'), noise(below(50)));
        out.resize(below(out.size() + 1));
        return out;
      }
      case 2: {  // a name without an end
        Buffer out = fragment({sequence_++, number(), 0, 0, 2}, name, 0);
        out.insert(out.end() - 1, 100, std::uint8_t('x'));
        out.pop_back();
        return out;
      }
      case 3: return fragment({sequence_++, std::uint32_t(2000 + below(100'000)), 0, 0, 2}, name, below(1200));
      case 4:
        return fragment(
            {sequence_ - 1, std::uint32_t(2000 + below(100'000)), 0xFFFFFFFFu - std::uint32_t(below(2000)), 1, 2}, name,
            bytes);
      case 5: return fragment({sequence_ - 1, number(), number(), 1, 2}, name, bytes);
      case 6: return fragment({sequence_, number(), number(), number16(), number16()}, name, bytes);
      default: {
        Buffer out = fragment({sequence_, number(), number(), number16(), number16()}, name, bytes);
        out.resize(below(24));
        return out;
      }
    }
  }

 private:
  static constexpr std::array<std::string_view, 11> names{
      channel::haptic_problem, channel::device_state, channel::haptic_status, channel::render_frame,
      channel::scene_info,     channel::sim_event,    channel::user_command,  channel::hand_input,
      channel::metrics,        channel::servo_ticks,  channel::soft_guide};

  std::size_t below(std::size_t n) { return random_() % n; }
  std::uint32_t number() {
    static constexpr std::uint32_t edges[] = {0,          1,      0x7FFFFFFF, 0x80000000, 0xFFFFFFFF,
                                              0xFFFF0000, 65'487, 65'507,     524'288,    524'289};
    return below(2) ? edges[below(std::size(edges))] + std::uint32_t(below(3)) - 1 : std::uint32_t(random_());
  }
  std::uint16_t number16() { return below(2) ? std::uint16_t(below(4)) : std::uint16_t(random_()); }
  Buffer noise(std::size_t bytes) {
    Buffer out(bytes);
    for (auto& b : out) b = std::uint8_t(random_());
    return out;
  }

  std::mt19937 random_;
  std::uint32_t sequence_ = 0;
};

}  // namespace insula::testing
