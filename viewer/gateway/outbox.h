// SPDX-License-Identifier: GPL-3.0-or-later
// Messages that wait to be sent to one client. Its size is bounded for any client: only the newest message of each kind
// of state is kept, and the last few hundred events.
#pragma once
#include <array>
#include <cstddef>
#include <cstdint>
#include <deque>

#include "viewer/gateway/framing.h"

namespace insula::gateway {

/// The first two are the most urgent. `room` is not on the bus: what persons write and draw.
enum class Topic { scene_info, sim_event, render_frame, device_state, haptic_status, metrics, room };
inline constexpr std::size_t topics = 6;  ///< of the bus

class Outbox {
 public:
  static constexpr std::size_t max_events = 256;

  void put(Topic topic, Message message) {
    if (topic == Topic::sim_event) return queue(events_, std::move(message));
    if (topic == Topic::room) return queue(room_, std::move(message));
    Message& slot = newest_[std::size_t(topic)];
    if (slot) ++dropped_;
    slot = std::move(message);
  }

  /// The most urgent message, or null. The topics after the first two alternate, so that each is sent.
  Message take() {
    if (Message m = std::move(newest_[std::size_t(Topic::scene_info)])) return m;
    for (auto* queued : {&events_, &room_}) {
      if (queued->empty()) continue;
      Message m = std::move(queued->front());
      queued->pop_front();
      return m;
    }
    constexpr std::size_t first = std::size_t(Topic::render_frame), count = topics - first;
    for (std::size_t i = 0; i < count; ++i) {
      turn_ = (turn_ + 1) % count;
      if (Message m = std::move(newest_[first + turn_])) return m;
    }
    return nullptr;
  }

  std::uint64_t dropped() const {
    return dropped_;
  }  ///< number of messages that a newer one replaced before they were sent

  /// Bytes held, for the tests.
  std::size_t bytes() const {
    std::size_t n = 0;
    for (const Message& m : newest_) n += m ? m->size() : 0;
    for (const auto* queued : {&events_, &room_})
      for (const Message& m : *queued) n += m->size();
    return n;
  }

 private:
  void queue(std::deque<Message>& messages, Message message) {
    if (messages.size() == max_events) {
      messages.pop_front();
      ++dropped_;
    }
    messages.push_back(std::move(message));
  }

  std::array<Message, topics> newest_;
  std::deque<Message> events_, room_;
  std::size_t turn_ = topics - 1 - std::size_t(Topic::render_frame);
  std::uint64_t dropped_ = 0;
};

}  // namespace insula::gateway
