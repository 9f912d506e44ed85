// SPDX-License-Identifier: GPL-3.0-or-later
// What an instructor's overview shows of this station. Used on the network thread.
#pragma once
#include <chrono>
#include <cstdint>
#include <deque>
#include <filesystem>
#include <insula_lcm/scene_info_t.hpp>
#include <insula_lcm/sim_event_t.hpp>
#include <string>
#include <string_view>

namespace insula::gateway {

class Station {
 public:
  using Clock = std::chrono::steady_clock;
  static constexpr std::size_t most_picture_bytes = 64 * 1024, most_alarms = 5;
  static constexpr int most_picture_px = 1024;  ///< each way

  /// name: empty: the machine's. choice: JSON with the person (engine/live/exercise_choice.h); empty: nobody is known.
  Station(std::string name, std::filesystem::path choice);

  const std::string& name() const { return name_; }
  std::string person() const;  ///< empty: nobody is known
  void scene(const insula_lcm::scene_info_t& info);
  void event(const insula_lcm::sim_event_t& event);  ///< faults and complications are alarms, until a reset
  void frame(double sim_time_s, Clock::time_point now);

  /// {name, person, title, state, time_s, frame_age_ms (-1: none yet), alarms: [{kind, text, time_s}], picture: a
  /// number that grows with each picture, 0: none}
  std::string json(Clock::time_point now) const;

  /// Takes a JPEG. The error text; empty: taken.
  std::string_view set_picture(std::string jpeg);
  const std::string& picture() const { return picture_; }  ///< empty: none

 private:
  struct Alarm {
    std::string kind, text;
    double time_s;
  };
  std::string name_;
  std::filesystem::path choice_;
  std::int64_t session_ = 0;
  std::string title_, state_;
  double time_s_ = 0;
  Clock::time_point frame_at_{};
  std::deque<Alarm> alarms_;
  std::string picture_;
  std::uint64_t pictures_ = 0;
};

/// Whether the bytes are a JPEG of at most that many pixels each way, by its markers.
bool is_jpeg(std::string_view bytes, int most_px);

}  // namespace insula::gateway
