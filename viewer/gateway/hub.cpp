// SPDX-License-Identifier: GPL-3.0-or-later
// Bus messages to clients and back.
#include "viewer/gateway/hub.h"

#include <algorithm>
#include <nlohmann/json.hpp>

#include "core/bus/codec.h"
#include "viewer/gateway/room_message.h"

namespace insula::gateway {
namespace {

using Clock = std::chrono::steady_clock;
constexpr auto device_state_period = std::chrono::microseconds(1'000'000 / 30);

std::int64_t now_us() {
  return std::chrono::duration_cast<std::chrono::microseconds>(Clock::now().time_since_epoch()).count();
}

constexpr std::array<std::string_view, topics> channel_of{channel::scene_info,    channel::sim_event,
                                                          channel::render_frame,  channel::device_state,
                                                          channel::haptic_status, channel::metrics};

const Hub::Taken malformed{false, "", "malformed"};

}  // namespace

Hub::Hub(Bus& bus, Post on_network_thread) : bus_(bus), post_(std::move(on_network_thread)) {
  forward(channel::render_frame, Topic::render_frame, render_frame_);
  forward(channel::scene_info, Topic::scene_info, scene_info_);
  forward(channel::sim_event, Topic::sim_event, sim_event_);
  forward(channel::haptic_status, Topic::haptic_status, haptic_status_);
  forward(channel::metrics, Topic::metrics, metrics_);
  forward(channel::device_state, Topic::device_state, device_state_);
}

template <class T>
void Hub::forward(std::string_view channel, Topic topic, T& scratch) {
  bus_.subscribe(channel, [this, channel, topic, &scratch](Bytes payload) {
    Count& count = counts_[std::size_t(topic)];
    ++count.received;
    if (topic == Topic::device_state) {
      // 250 a second on the bus; a picture needs 30.
      const auto now = Clock::now();
      if (now < next_device_state_) return;
      next_device_state_ = std::max(next_device_state_ + device_state_period, now);
    }
    std::string why;
    if (!decode(payload, scratch, why)) {
      ++count.refused;
      return;
    }
    Message message = frame(channel, payload);
    if constexpr (std::is_same_v<T, insula_lcm::scene_info_t>) {
      post_([this, message, info = scratch] {
        last_scene_info_ = message;
        session_ = info.session;
        state_ = info.state;
        bundle_.set(info.session, info.bundle);
        if (station_) station_->scene(info);
        broadcast(Topic::scene_info, message);
      });
    } else if constexpr (std::is_same_v<T, insula_lcm::sim_event_t>) {
      post_([this, message, event = scratch] {
        if (station_) station_->event(event);
        broadcast(Topic::sim_event, message);
      });
    } else if constexpr (std::is_same_v<T, insula_lcm::render_frame_t>) {
      last_frame_us_ = now_us();
      post_([this, message, time_s = scratch.sim_time_s] {
        if (station_) station_->frame(time_s, Clock::now());
        broadcast(Topic::render_frame, message);
      });
    } else {
      post_([this, topic, message] { broadcast(topic, message); });
    }
  });
}

void Hub::poll(int timeout_ms) { bus_.poll(timeout_ms); }

void Hub::broadcast(Topic topic, const Message& message) {
  for (const auto& client : clients_) client->send(topic, message);
  sent_ += clients_.size();
}

void Hub::join(const std::shared_ptr<Client>& client) {
  clients_.insert(client);
  ++clients_ever_;
  if (last_scene_info_) client->send(Topic::scene_info, last_scene_info_);
  if (client->visitor().rights().speaks) tell_pages();
}

void Hub::leave(const Client* client) {
  for (HeldHand& held : held_)
    if (held.page == client) held.page = nullptr;
  const auto found = std::find_if(clients_.begin(), clients_.end(), [&](const auto& c) { return c.get() == client; });
  if (found == clients_.end()) return;
  dropped_by_left_ += (*found)->dropped();
  const std::shared_ptr<Client> left = *found;
  clients_.erase(found);
  leave_room(*left);
}

Hub::Taken Hub::command_from_page(Bytes payload) {
  auto message = decode<insula_lcm::user_command_t>(payload);
  if (!message) return malformed;
  for (std::size_t i = 0; i < held_.size(); ++i)
    if (message->command == "reset" || message->command == "begin" ||
        (message->command == "release" && message->argument != (i == 0 ? "right" : "left")))
      held_[i].page = nullptr;
  message->time_us = now_us();  // a browser's clock means nothing here
  const bool sent = publish(bus_, channel::user_command, *message, scratch_);
  return {sent, message->command + (message->argument.empty() ? "" : " " + message->argument),
          sent ? "" : "the bus does not take it"};
}

Hub::Taken Hub::hand_from_page(Bytes payload, const Client* page) {
  auto message = decode<insula_lcm::hand_input_t>(payload);
  if (!message) return malformed;
  message->time_us = now_us();
  HeldHand& held = held_[message->hand == 1 ? 1 : 0];
  held.page = page;
  held.input = *message;
  held.asked = held.sent = Clock::now();
  return {publish(bus_, channel::hand_input, held.input, scratch_), "hand", "the bus does not take it", true};
}

void Hub::repeat_hands(Clock::time_point now) {
  for (HeldHand& held : held_) {
    if (!held.page || now - held.sent < repeat_period) continue;
    if (now - held.asked > longest_busy) {
      held.page = nullptr;
      continue;
    }
    held.sent = now;
    held.input.time_us = now_us();
    publish(bus_, channel::hand_input, held.input, scratch_);
  }
}

Hub::Taken Hub::from_page(Bytes framed, const Visitor& visitor, const Client* page) {
  const Rights rights = visitor.rights();
  Taken taken = malformed;
  if (const auto parts = unframe(framed)) {
    if (parts->channel == channel::user_command)
      taken = rights.commands ? command_from_page(parts->payload) : Taken{false, "command", "not allowed"};
    else if (parts->channel == channel::hand_input)
      taken = rights.hands ? hand_from_page(parts->payload, page) : Taken{false, "hand", "not allowed", true};
    else if (parts->channel == room_channel) taken = room_from_page(parts->payload, visitor, page);
  }
  ++(taken.accepted ? page_accepted_ : page_refused_);
  return taken;
}

std::string Hub::health() const {
  std::uint64_t dropped = dropped_by_left_;
  for (const auto& client : clients_) dropped += client->dropped();
  nlohmann::ordered_json j;
  j["ok"] = bus_.good();
  if (!bus_.good()) j["error"] = bus_.error();
  j["uptime_s"] = std::chrono::duration<double>(Clock::now() - started_).count();
  j["session"] = session_;
  j["state"] = state_;
  j["last_frame_age_ms"] = last_frame_us_ == 0 ? -1.0 : double(now_us() - last_frame_us_) / 1000;
  j["clients"] = clients_.size();
  j["clients_ever"] = clients_ever_;
  j["sent"] = sent_;
  j["dropped"] = dropped;
  j["from_pages"] = {{"accepted", page_accepted_}, {"refused", page_refused_}};
  for (std::size_t i = 0; i < topics; ++i)
    j["channels"][std::string(channel_of[i])] = {{"received", counts_[i].received.load()},
                                                 {"refused", counts_[i].refused.load()}};
  return j.dump(1) + "\n";
}

}  // namespace insula::gateway
