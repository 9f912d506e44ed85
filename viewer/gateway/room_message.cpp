// SPDX-License-Identifier: GPL-3.0-or-later
#include "viewer/gateway/room_message.h"

#include <cmath>
#include <nlohmann/json.hpp>

#include "core/base/text.h"
#include "viewer/gateway/voice_message.h"

namespace insula::gateway {
namespace {

using Json = nlohmann::json;

constexpr std::size_t most_bytes_said = 16 * 1024, most_text = 380, most_points = 128;
constexpr double farthest_m = 10;  // no scene is larger

std::string string_at(const Json& json, const char* name) {
  const auto found = json.find(name);
  return found != json.end() && found->is_string() ? found->get<std::string>() : std::string();
}

bool is_point(const Json& point) {
  if (!point.is_array() || point.size() != 3) return false;
  for (const Json& x : point)
    if (!x.is_number() || !(std::abs(x.get<double>()) <= farthest_m)) return false;
  return true;
}

bool are_points(const Json& points) {
  if (!points.is_array() || points.empty() || points.size() > most_points) return false;
  for (const Json& point : points)
    if (!is_point(point)) return false;
  return true;
}

RoomMessage refused(std::string what, std::string_view why) { return {{}, std::move(what), why, false, 0}; }

RoomMessage written(Json json, std::string what, const Visitor& visitor) {
  json["from"] = name_of(visitor.role);
  return {json.dump(), std::move(what), {}, false, 0};
}

RoomMessage said(const Json& json, const Visitor& visitor) {
  const std::string text = string_at(json, "text");
  if (!visitor.rights().speaks) return refused("say", "not allowed");
  if (text.empty() || text.size() > most_text) return refused("say", "malformed");
  return written({{"kind", "say"}, {"text", text}}, "say " + text, visitor);
}

RoomMessage drawn(const std::string& kind, const Json& json, const Visitor& visitor) {
  if (!visitor.rights().draws) return refused(kind, "not allowed");
  if (kind == "clear") return written({{"kind", kind}}, kind, visitor);
  if (kind == "point") {
    const auto at = json.find("at");
    if (at == json.end() || !is_point(*at)) return refused(kind, "malformed");
    return written({{"kind", kind}, {"at", *at}}, kind, visitor);
  }
  const auto id = json.find("id"), points = json.find("points");
  if (id == json.end() || !id->is_number_unsigned() || points == json.end() || !are_points(*points))
    return refused(kind, "malformed");
  return written({{"kind", kind}, {"id", *id}, {"points", *points}}, "stroke " + id->dump(), visitor);
}

}  // namespace

RoomMessage read_room_message(Bytes payload, const Visitor& visitor) {
  const std::string_view text(reinterpret_cast<const char*>(payload.data()), payload.size());
  if (text.size() > most_bytes_said) return refused({}, "too long");
  const Json json = Json::parse(text, nullptr, false);
  if (!json.is_object() || find_invalid_utf8(text) != std::string_view::npos) return refused({}, "malformed");
  const std::string kind = string_at(json, "kind");
  if (kind == "say") return said(json, visitor);
  if (kind == "voice") return read_voice_message(json, visitor);
  if (kind == "stroke" || kind == "point" || kind == "clear") return drawn(kind, json, visitor);
  return refused({}, "malformed");
}

}  // namespace insula::gateway
