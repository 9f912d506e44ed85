// SPDX-License-Identifier: GPL-3.0-or-later
// How two pages of a station agree to talk by voice. The sound itself goes from browser to browser (WebRTC) and never
// through here. Messages of the channel ROOM:
//   {"kind": "voice", "step": "ring"}                       to the pages of the other side
//   {"kind": "voice", "step": "accept", "to": page}         to the page that rang
//   {"kind": "voice", "step": "offer" or "answer", "to": page, "sdp": a session's description (RFC 8866)}
//   {"kind": "voice", "step": "end"}                        to the pages of the other side; "to" may name one
// Each gets "from", the role, and "page", the number of the page that sent it.
#pragma once
#include <nlohmann/json_fwd.hpp>
#include <string_view>

#include "viewer/gateway/room_message.h"

namespace insula::gateway {

RoomMessage read_voice_message(const nlohmann::json& json, const Visitor& visitor);

/// Of a page that left or was away: the others hang up.
RoomMessage voice_ended(const Visitor& visitor);

/// A session's description with one stream of sound and nothing else, of at most 8 KB of printable ASCII.
bool is_sound_description(std::string_view sdp);

}  // namespace insula::gateway
