// SPDX-License-Identifier: GPL-3.0-or-later
// The address of the bus in LCM's notation: udpm://GROUP:PORT?ttl=N&recv_buf_size=BYTES.
#pragma once
#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

namespace insula {

struct UdpmAddress {
  std::array<std::uint8_t, 4> group{239, 255, 76, 67};  ///< IPv4 multicast group
  std::uint16_t port = 7667;
  int ttl = 0;                           ///< hops: 0 keeps messages on this machine
  int receive_buffer_bytes = 2'097'152;  ///< requested from the kernel, which limits it to net.core.rmem_max
};

/// The parts of a udpm URL. Missing parts keep their defaults. Returns nothing if the URL is malformed, has an unknown
/// option, or its group is not a multicast group.
std::optional<UdpmAddress> parse_udpm_url(std::string_view url);

}  // namespace insula
