// SPDX-License-Identifier: GPL-3.0-or-later
// The datagrams of LCM's UDP protocol: how a message is split into datagrams and reassembled. Every size and offset of
// a received datagram is checked before it is used. Source: LCM, "UDP Multicast Protocol Description". All numbers are
// big-endian. A short message is: "LC02", sequence number, channel name with a zero byte, payload. A fragment is:
// "LC03", sequence number, payload size, offset, fragment number, count of fragments; the first fragment then has the
// channel name with a zero byte; a piece of the payload follows.
#pragma once
#include <array>
#include <cstdint>
#include <functional>
#include <string_view>
#include <vector>

#include "core/bus/bus.h"
#include "core/bus/channels.h"

namespace insula::udpm {

inline constexpr std::size_t max_datagram_bytes = 65'507;  ///< the largest UDP payload over IPv4
inline constexpr std::size_t max_name_bytes = 63;          ///< of a channel, without its zero byte

/// One datagram of a message: its header, and a piece of the sender's bytes, which are not copied.
struct Datagram {
  std::array<std::uint8_t, 20 + max_name_bytes + 1> head;
  std::size_t head_bytes = 0;
  Bytes payload;
};

/// Calls `send` for each datagram of a message, in order, until it returns false. Returns whether all were sent. The
/// channel's name must have 1 to max_name_bytes characters and the message at most max_message_bytes.
bool cut(std::string_view channel, Bytes message, std::uint32_t sequence,
         const std::function<bool(const Datagram&)>& send);

/// A whole message; both parts are valid until the next call of Assembler::add.
struct Received {
  std::string_view channel;
  Bytes message;
};

/// Reassembles messages. Fragments of one message must come in order, as they do on one machine. A message with a gap
/// is dropped. Memory is bounded by max_senders messages.
class Assembler {
 public:
  static constexpr std::size_t max_senders = 16;

  /// Takes one datagram. `sender` tells senders apart (address and port). True if `out` is now a complete message.
  bool add(std::uint64_t sender, Bytes datagram, Received& out);
  /// Number of malformed or unexpected datagrams so far.
  std::uint64_t refused() const { return refused_; }

 private:
  struct Partial {
    std::uint64_t sender = 0, last_used = 0;
    std::uint32_t sequence = 0;
    std::uint16_t next_fragment = 0, fragments = 0;  // next_fragment 0: nothing is expected
    std::array<char, max_name_bytes> name{};
    std::size_t name_bytes = 0, filled = 0;
    std::vector<std::uint8_t> payload;
  };
  bool add_short(Bytes datagram, Received& out);
  bool add_fragment(std::uint64_t sender, Bytes datagram, Received& out);
  Partial* begin(std::uint64_t sender, Bytes datagram, Bytes& rest);
  Partial* find(std::uint64_t sender);
  bool refuse() {
    ++refused_;
    return false;
  }

  std::vector<Partial> partials_;
  std::uint64_t uses_ = 0, refused_ = 0;
};

}  // namespace insula::udpm
