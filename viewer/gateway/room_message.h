// SPDX-License-Identifier: GPL-3.0-or-later
// What persons at several pages of a station write, draw and point at: JSON on the WebSocket's channel ROOM, from page
// to pages. It never reaches the bus.
//   {"kind": "say", "text"}                      1 to 380 bytes
//   {"kind": "stroke", "id", "points": [[x, y, z], ...]}   adds points (scene, m) to the stroke of that number
//   {"kind": "point", "at": [x, y, z]}           where the instructor points now (scene, m)
//   {"kind": "clear"}                            wipes all strokes
//   {"kind": "voice", ...}                       voice_message.h
// The gateway itself tells pages:
//   {"kind": "pages", "instructors", "trainees"} how many pages of each are connected, for those who may speak
//   {"kind": "picture"}                          to pages of the trainee on this machine: an overview wants a picture
#pragma once
#include <cstdint>
#include <string>
#include <string_view>

#include "core/bus/bus.h"
#include "viewer/gateway/access.h"

namespace insula::gateway {

inline constexpr std::string_view room_channel = "ROOM";

struct RoomMessage {
  std::string json;      ///< written anew from what was checked, with "from": the role
  std::string what;      ///< for the record: the kind, and what was said
  std::string_view why;  ///< it is refused; empty: it is fine
  bool voice = false;    ///< only for pages of the other side (voice_message.h)
  std::uint64_t to = 0;  ///< of these, the page with that number; 0: all
};

RoomMessage read_room_message(Bytes payload, const Visitor& visitor);

}  // namespace insula::gateway
