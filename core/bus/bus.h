// SPDX-License-Identifier: GPL-3.0-or-later
// Publish and subscribe of messages between processes, or inside one. A message is a channel name and bytes (see
// codec.h).
#pragma once
#include <cstdint>
#include <functional>
#include <memory>
#include <span>
#include <string>
#include <string_view>

namespace insula {

using Bytes = std::span<const std::uint8_t>;

/// One endpoint. `publish` may be called from any thread; `subscribe` and `poll` from one thread at a time. Handlers
/// run inside `poll`, in the order of arrival. An endpoint also receives its own messages if it subscribed to them.
class Bus {
 public:
  using Handler = std::function<void(Bytes)>;

  virtual ~Bus() = default;
  /// Sends one whole message. False when it could not be sent; error() then gives the reason.
  virtual bool publish(std::string_view channel, Bytes message) = 0;
  /// Calls `handler` for each message of exactly this channel. Must not be called from inside a handler.
  virtual void subscribe(std::string_view channel, Handler handler) = 0;
  /// Waits at most timeout_ms for a first message, then handles the waiting messages, up to a bounded number. Returns
  /// how many were handled. Passes on an exception of a handler.
  virtual int poll(int timeout_ms) = 0;
  /// False when the endpoint cannot work: not created, or the last message could not be sent.
  virtual bool good() const = 0;
  /// Description of the error and its remedy, one or more lines; empty when good.
  virtual std::string error() const = 0;
};

/// "udpm://..." gives an LcmBus, and "memq://" a MemBus on a hub of its own. "" gives the URL of LCM_DEFAULT_URL or, if
/// that is not set, udpm://239.255.76.67:7667?ttl=0. Never null: check good() and show error().
std::unique_ptr<Bus> make_bus(std::string_view url = {});

}  // namespace insula
