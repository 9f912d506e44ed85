// SPDX-License-Identifier: GPL-3.0-or-later
// Conversion between messages and bytes. Decoders accept any input. Garbage, truncated or hostile bytes give `false`
// and a reason, never an exception, a read out of bounds or a large allocation. The target then stays as it was or, for
// generated types, must not be used.
//
//   insula_lcm::scene_info_t info;            std::vector<std::uint8_t> bytes;  std::string why;
//   encode(info, bytes);                      // false when counts and vector sizes disagree
//   if (!decode(bytes, info, why)) log(why);  // structure checked, then decoded, then plausible(info, why)
//
// haptic_problem_t goes through encode_problem / decode_problem of haptic_update.h instead.
#pragma once
#include <cstdint>
#include <insula_lcm/device_state_t.hpp>
#include <insula_lcm/hand_input_t.hpp>
#include <insula_lcm/haptic_status_t.hpp>
#include <insula_lcm/metrics_t.hpp>
#include <insula_lcm/render_frame_t.hpp>
#include <insula_lcm/scene_info_t.hpp>
#include <insula_lcm/servo_ticks_t.hpp>
#include <insula_lcm/session_step_t.hpp>
#include <insula_lcm/sim_event_t.hpp>
#include <insula_lcm/soft_guide_t.hpp>
#include <insula_lcm/user_command_t.hpp>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "core/bus/bus.h"
#include "core/bus/channels.h"
#include "core/bus/plausible.h"

namespace insula {

/// Whether the bytes have the structure of the type: fingerprint, valid counts, complete strings, exact length. Checks
/// every count before anything is allocated.
bool well_formed(const insula_lcm::device_state_t*, Bytes bytes);
bool well_formed(const insula_lcm::hand_input_t*, Bytes bytes);
bool well_formed(const insula_lcm::haptic_status_t*, Bytes bytes);
bool well_formed(const insula_lcm::metrics_t*, Bytes bytes);
bool well_formed(const insula_lcm::render_frame_t*, Bytes bytes);
bool well_formed(const insula_lcm::scene_info_t*, Bytes bytes);
bool well_formed(const insula_lcm::servo_ticks_t*, Bytes bytes);
bool well_formed(const insula_lcm::session_step_t*, Bytes bytes);
bool well_formed(const insula_lcm::sim_event_t*, Bytes bytes);
bool well_formed(const insula_lcm::soft_guide_t*, Bytes bytes);
bool well_formed(const insula_lcm::user_command_t*, Bytes bytes);

/// Empties vectors whose new count is 0, which the generated decoder leaves unchanged in a reused object.
void drop_stale(insula_lcm::render_frame_t& message);
void drop_stale(insula_lcm::servo_ticks_t& message);
void drop_stale(insula_lcm::session_step_t& message);
template <class Message>
void drop_stale(Message&) {}

/// Writes the bytes of a message to `out`, which keeps its capacity. False when its counts and vector sizes disagree.
template <class Message>
bool encode(const Message& message, std::vector<std::uint8_t>& out) {
  out.clear();
  if (!consistent(message)) return false;
  out.resize(std::size_t(message.getEncodedSize()));
  return message.encode(out.data(), 0, int(out.size())) == int(out.size());
}

/// Decodes and validates. `into` changes only if the structure is valid. Use it only if this returns true.
template <class Message>
bool decode(Bytes bytes, Message& into, std::string& why) {
  if (bytes.size() > max_message_bytes) {
    why = "message too large";
    return false;
  }
  if (!well_formed(static_cast<const Message*>(nullptr), bytes)) {
    why = "not a " + std::string(Message::getTypeName()) + " message";
    return false;
  }
  if (into.decode(bytes.data(), 0, int(bytes.size())) != int(bytes.size())) {
    why = "cannot decode";
    return false;
  }
  drop_stale(into);
  return plausible(into, why);
}

template <class Message>
std::optional<Message> decode(Bytes bytes) {
  Message message{};
  std::string why;
  if (!decode(bytes, message, why)) return std::nullopt;
  return message;
}

/// Encodes into `scratch` and publishes.
template <class Message>
bool publish(Bus& bus, std::string_view channel, const Message& message, std::vector<std::uint8_t>& scratch) {
  return encode(message, scratch) && bus.publish(channel, scratch);
}

}  // namespace insula
