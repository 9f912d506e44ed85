// SPDX-License-Identifier: GPL-3.0-or-later
// The address of the bus as LCM writes it: udpm://GROUP:PORT?ttl=N&recv_buf_size=BYTES.
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
  int receive_buffer_bytes = 2'097'152;  ///< asked of the kernel, which caps it at net.core.rmem_max
};

/// The parts of a udpm URL; parts that are left out keep their defaults. Nothing when the URL is malformed, when the
/// group is no multicast group, or when it has an unknown option.
std::optional<UdpmAddress> parse_udpm_url(std::string_view url);

}  // namespace insula
