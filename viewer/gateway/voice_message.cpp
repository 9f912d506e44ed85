// SPDX-License-Identifier: GPL-3.0-or-later
#include "viewer/gateway/voice_message.h"

#include <algorithm>
#include <nlohmann/json.hpp>

namespace insula::gateway {
namespace {

using VoiceJson = nlohmann::json;

constexpr std::size_t most_description_bytes = 8 * 1024;

RoomMessage voice_step(std::string_view step, std::uint64_t to, const VoiceJson& sdp, const Visitor& visitor) {
  VoiceJson out{{"kind", "voice"}, {"step", step}, {"from", name_of(visitor.role)}, {"page", visitor.page}};
  if (!sdp.is_null()) out["sdp"] = sdp;
  return {out.dump(), "voice " + std::string(step), {}, true, to};
}

}  // namespace

bool is_sound_description(std::string_view sdp) {
  const auto printable = [](char c) { return (c >= ' ' && c <= '~') || c == '\r' || c == '\n'; };
  if (sdp.size() > most_description_bytes || !sdp.starts_with("v=0") || !std::all_of(sdp.begin(), sdp.end(), printable))
    return false;
  int streams = 0;
  for (std::size_t at = sdp.find("\nm="); at != sdp.npos; at = sdp.find("\nm=", at + 1)) {
    if (!sdp.substr(at + 3).starts_with("audio ")) return false;
    ++streams;
  }
  return streams == 1;
}

RoomMessage read_voice_message(const VoiceJson& json, const Visitor& visitor) {
  const auto refuse = [](std::string_view why) { return RoomMessage{{}, "voice", why, true, 0}; };
  if (!visitor.rights().speaks) return refuse("not allowed");
  const std::string step = json.value("step", VoiceJson()).is_string() ? json["step"].get<std::string>() : "";
  const VoiceJson to = json.value("to", VoiceJson()), sdp = json.value("sdp", VoiceJson());
  const bool one = to.is_number_unsigned() && to.get<std::uint64_t>() > 0;
  if (!one && !to.is_null()) return refuse("malformed");
  const std::uint64_t page = one ? to.get<std::uint64_t>() : 0;
  if (step == "ring" && !one) return voice_step(step, 0, {}, visitor);
  if (step == "end" || (step == "accept" && one)) return voice_step(step, page, {}, visitor);
  const bool described = sdp.is_string() && is_sound_description(sdp.get_ref<const std::string&>());
  if ((step == "offer" || step == "answer") && one && described) return voice_step(step, page, sdp, visitor);
  return refuse("malformed");
}

RoomMessage voice_ended(const Visitor& visitor) { return voice_step("end", 0, {}, visitor); }

}  // namespace insula::gateway
