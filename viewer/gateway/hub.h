// SPDX-License-Identifier: GPL-3.0-or-later
// Connects the bus and the clients. Messages of the bus go to every client's outbox. Messages of a page are checked and
// go to the bus.
#pragma once
#include <array>
#include <atomic>
#include <chrono>
#include <cstdint>
#include <functional>
#include <insula_lcm/device_state_t.hpp>
#include <insula_lcm/hand_input_t.hpp>
#include <insula_lcm/haptic_status_t.hpp>
#include <insula_lcm/metrics_t.hpp>
#include <insula_lcm/render_frame_t.hpp>
#include <insula_lcm/scene_info_t.hpp>
#include <insula_lcm/sim_event_t.hpp>
#include <map>
#include <memory>
#include <set>
#include <string>
#include <vector>

#include "core/bus/bus.h"
#include "viewer/gateway/access.h"
#include "viewer/gateway/bundle.h"
#include "viewer/gateway/outbox.h"
#include "viewer/gateway/rate_limit.h"
#include "viewer/gateway/station.h"

namespace insula::gateway {

/// A connected page for the hub. Called on the network thread.
class Client {
 public:
  virtual ~Client() = default;
  virtual void send(Topic topic, const Message& message) = 0;
  virtual std::uint64_t dropped() const = 0;
  virtual const Visitor& visitor() const = 0;
};

class Hub {
 public:
  /// `on_network_thread` runs a function on the network thread, later, in order.
  using Post = std::function<void(std::function<void()>)>;
  Hub(Bus& bus, Post on_network_thread);

  /// Waits up to timeout_ms for messages and passes them on. Called only by the bus thread.
  void poll(int timeout_ms);

  // The rest is called only on the network thread.
  void join(const std::shared_ptr<Client>& client);  ///< gets the last SCENE_INFO at once
  void leave(const Client* client);
  /// Handles a page's message. Only a valid, plausible USER_COMMAND or HAND_INPUT for which the page has the right is
  /// passed on, and words and strokes (room_message.h) to the other pages. Others are counted and dropped.
  struct Taken {
    bool accepted = false;
    std::string what;      ///< the command with its argument, or the channel; empty: it could not be read
    std::string_view why;  ///< it was refused
    bool many = false;     ///< one of many with the same `what`: poses of a hand, parts of a stroke
  };
  Taken from_page(Bytes framed, const Visitor& visitor, const Client* page = nullptr);
  /// Called every repeat_period. Sends the last pose of each hand again whose page is connected but busy, for example
  /// with drawing. The haptic server otherwise takes such a page for lost. A page that is silent for longest_busy is.
  void repeat_hands(std::chrono::steady_clock::time_point now);
  static constexpr std::chrono::milliseconds repeat_period{50}, longest_busy{1500};
  /// Asks the trainee's pages on this machine for a picture, unless they were asked just now.
  void want_picture(std::chrono::steady_clock::time_point now);
  static constexpr std::chrono::milliseconds picture_period{3000};
  /// Counts a page's message that was dropped before it was checked (text, too many per second).
  void refuse_from_page() { ++page_refused_; }
  /// Tells it what is on the bus.
  void watch(Station& station) { station_ = &station; }
  std::string health() const;  ///< JSON
  Bundle& bundle() { return bundle_; }

 private:
  template <class T>
  void forward(std::string_view channel, Topic topic, T& scratch);
  void broadcast(Topic topic, const Message& message);
  Taken command_from_page(Bytes payload);
  Taken hand_from_page(Bytes payload, const Client* page);
  Taken room_from_page(Bytes payload, const Visitor& visitor, const Client* page);
  bool may_ring(const Client* page);
  /// Sends JSON of the room to the pages that satisfy a condition. Their number.
  int tell(const std::string& json, const std::function<bool(const Client&)>& whom);
  void tell_pages();
  void leave_room(const Client& left);

  Bus& bus_;
  Post post_;

  // Bus thread.
  insula_lcm::render_frame_t render_frame_{};
  insula_lcm::scene_info_t scene_info_{};
  insula_lcm::sim_event_t sim_event_{};
  insula_lcm::haptic_status_t haptic_status_{};
  insula_lcm::metrics_t metrics_{};
  insula_lcm::device_state_t device_state_{};
  std::chrono::steady_clock::time_point next_device_state_{};

  // Both threads.
  struct Count {
    std::atomic<std::uint64_t> received{0}, refused{0};
  };
  std::array<Count, topics> counts_;
  std::atomic<std::int64_t> last_frame_us_{0};

  // Network thread.
  std::set<std::shared_ptr<Client>> clients_;  // order does not matter: each gets the same
  Station* station_ = nullptr;
  Message last_scene_info_;
  std::int64_t session_ = 0;
  std::string state_;
  Bundle bundle_;
  /// The last pose that a page asked for, by hand.
  struct HeldHand {
    const Client* page = nullptr;  ///< none: nobody holds it
    insula_lcm::hand_input_t input{};
    std::chrono::steady_clock::time_point asked{}, sent{};
  };
  std::array<HeldHand, 2> held_{};
  std::map<const Client*, RateLimit> voices_;  ///< of pages that have begun to talk
  std::chrono::steady_clock::time_point picture_wanted_{};
  std::vector<std::uint8_t> scratch_;
  std::uint64_t page_accepted_ = 0, page_refused_ = 0, clients_ever_ = 0, sent_ = 0, dropped_by_left_ = 0;
  std::chrono::steady_clock::time_point started_ = std::chrono::steady_clock::now();
};

}  // namespace insula::gateway
