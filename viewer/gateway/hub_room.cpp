// SPDX-License-Identifier: GPL-3.0-or-later
// What the pages of a station tell each other, and what the gateway tells them.
#include <nlohmann/json.hpp>

#include "viewer/gateway/hub.h"
#include "viewer/gateway/voice_message.h"

namespace insula::gateway {
namespace {

constexpr double rings_a_second = 2, rings_at_once = 20;

}  // namespace

int Hub::tell(const std::string& json, const std::function<bool(const Client&)>& whom) {
  const Message framed = frame(room_channel, {reinterpret_cast<const std::uint8_t*>(json.data()), json.size()});
  int told = 0;
  for (const auto& client : clients_) {
    if (!whom(*client)) continue;
    client->send(Topic::room, framed);
    ++told;
  }
  return told;
}

Hub::Taken Hub::room_from_page(Bytes payload, const Visitor& visitor, const Client* page) {
  const RoomMessage message = read_room_message(payload, visitor);
  if (!message.why.empty()) return {false, message.what, message.why};
  if (message.voice && !may_ring(page)) return {false, message.what, "too many"};
  const int heard = tell(message.json, [&](const Client& client) {
    const Visitor& v = client.visitor();
    const bool other_side = v.rights().speaks && v.role != visitor.role && (message.to == 0 || message.to == v.page);
    return &client != page && (!message.voice || other_side);
  });
  if (message.to != 0 && heard == 0) return {false, message.what, "there is no such page"};
  const bool many = message.what == "point" || message.what.starts_with("stroke");
  return {true, message.what, "", many};
}

bool Hub::may_ring(const Client* page) {
  return voices_.try_emplace(page, rings_a_second, rings_at_once).first->second.take(RateLimit::Clock::now());
}

void Hub::tell_pages() {
  const auto speaks = [](const Client& client) { return client.visitor().rights().speaks; };
  int instructors = 0, trainees = 0;
  for (const auto& client : clients_)
    if (speaks(*client)) ++(client->visitor().role == Role::instructor ? instructors : trainees);
  tell(nlohmann::json{{"kind", "pages"}, {"instructors", instructors}, {"trainees", trainees}}.dump(), speaks);
}

/// Who talked with it hangs up.
void Hub::leave_room(const Client& left) {
  if (voices_.erase(&left) > 0)
    tell(voice_ended(left.visitor()).json, [](const Client& client) { return client.visitor().rights().speaks; });
  if (left.visitor().rights().speaks) tell_pages();
}

void Hub::want_picture(std::chrono::steady_clock::time_point now) {
  if (now - picture_wanted_ < picture_period) return;
  picture_wanted_ = now;
  tell(R"({"kind":"picture"})", [](const Client& client) { return client.visitor().rights().hands; });
}

}  // namespace insula::gateway
