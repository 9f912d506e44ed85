// SPDX-License-Identifier: GPL-3.0-or-later
// A bus message on a WebSocket: one byte length of the channel's name, the name in ASCII, the payload as on the bus.
#pragma once
#include <cstdint>
#include <memory>
#include <optional>
#include <string_view>
#include <vector>

#include "core/bus/bus.h"

namespace insula::gateway {

/// Shared by all clients that get the message.
using Message = std::shared_ptr<const std::vector<std::uint8_t>>;

inline Message frame(std::string_view channel, Bytes payload) {
  auto out = std::make_shared<std::vector<std::uint8_t>>();
  out->reserve(1 + channel.size() + payload.size());
  out->push_back(std::uint8_t(channel.size()));
  out->insert(out->end(), channel.begin(), channel.end());
  out->insert(out->end(), payload.begin(), payload.end());
  return out;
}

struct Unframed {
  std::string_view channel;  // both point into the given bytes
  Bytes payload;
};

inline std::optional<Unframed> unframe(Bytes bytes) {
  if (bytes.empty() || bytes[0] == 0 || bytes.size() < 1u + bytes[0]) return std::nullopt;
  const std::size_t length = bytes[0];
  return Unframed{{reinterpret_cast<const char*>(bytes.data()) + 1, length}, bytes.subspan(1 + length)};
}

}  // namespace insula::gateway
