// SPDX-License-Identifier: GPL-3.0-or-later
// Records a run into one file: what the simulation is given in each step, the hash of its state and the metrics once a
// second, channels, events, and pictures. docs/session-format.md describes the file.
//
// step() copies a few hundred bytes into a buffer, and ten times a second a picture. A thread compresses and writes
// them, so a slow disk never delays a step. When the file cannot be written, the recording ends, failure() says why,
// and the run continues.
#pragma once
#include <array>
#include <atomic>
#include <condition_variable>
#include <cstdint>
#include <filesystem>
#include <insula_lcm/session_step_t.hpp>
#include <insula_lcm/sim_event_t.hpp>
#include <map>
#include <memory>
#include <mutex>
#include <string>
#include <thread>
#include <vector>

#include "core/container/mcap_writer.h"
#include "core/sim/simulation.h"
#include "engine/session/picture_recorder.h"

namespace insula {

/// What a session says of itself besides its scene.
struct SessionAbout {
  std::filesystem::path scene;
  std::string motion, mode;  ///< as named by the person; empty: none
  /// What the person says of the session: "person", "level", ... Names must be those of valid_field().
  std::map<std::string, std::string> fields = {};
};

class SessionRecorder {
 public:
  /// Called after loading, before the first step. Throws InputError if the file cannot be created.
  SessionRecorder(const std::filesystem::path& file, const Simulation& simulation, const SessionAbout& about);
  /// Ends the file.
  ~SessionRecorder();
  SessionRecorder(const SessionRecorder&) = delete;
  SessionRecorder& operator=(const SessionRecorder&) = delete;

  /// After each step.
  void step(const Simulation& simulation);
  /// Before a reset: the metrics of the pass through the exercise that ends.
  void end_pass(const Simulation& simulation);
  /// Events that belong to no step. An event "mode" says in which mode the session goes on.
  void note(const std::vector<Event>& events);
  /// {pass, review} of a pass that has ended, as JSON.
  void review(const std::string& json) { put_text(review_channel_, json); }
  /// Number of the present pass through the exercise, from 1; 0 before the first step.
  int pass() const { return pass_; }
  /// The haptic server's message on both hands, as it came: devices, poses, buttons. One of kept_hands is kept, and
  /// while no step is made only the first ones.
  void hands(mcap::Bytes device_state);
  /// Every tick of the servo, as it came (servo_ticks_t). Also kept for a moment only while no step is made.
  void ticks(mcap::Bytes servo_ticks);
  /// Writes what is left, with the hash of the last step, and ends the file.
  void close(const Simulation& simulation);

  /// Why the recording has ended early; empty: it has not.
  std::string failure() const;
  const std::filesystem::path& file() const { return file_; }
  /// Time of a processor that the thread which compresses and writes has used, s.
  double writer_cpu_seconds() const { return writer_cpu_s_; }

  /// Number of steps from one kept hash to the next. A rerun compares at these places.
  static std::int64_t steps_a_second(double h);
  static constexpr int channels_a_second = 10;
  static constexpr int kept_hands = 4;  ///< of the messages on hands one of so many is kept
  /// Memory for messages that the disk has not taken. With more the recording ends.
  static constexpr std::size_t most_waiting_bytes = 64u << 20;

 private:
  void add_channels(const Simulation& simulation);
  /// first_of_chunk: messages of its lane before it go to the file before.
  void put(std::uint16_t channel, mcap::Bytes message, bool first_of_chunk = false);
  void put_picture(const Simulation& simulation);
  void put_step(const Simulation& simulation, bool hashed);
  void put_events(const std::vector<Event>& events);
  void put_metrics(const Simulation& simulation, bool last_of_pass);
  void put_channels(const Simulation& simulation);
  void put_hands(const Simulation& simulation);
  void put_text(std::uint16_t channel, const std::string& text);
  void write_until_closed();
  void finish();
  void fail(const std::string& why);

  std::filesystem::path file_;
  std::unique_ptr<McapWriter> out_;  ///< the thread's once it runs
  std::uint16_t step_channel_ = 0, event_channel_ = 0, hands_channel_ = 0, ticks_channel_ = 0, metrics_channel_ = 0,
                channels_channel_ = 0, forces_channel_ = 0, frame_channel_ = 0, geometry_channel_ = 0,
                review_channel_ = 0;
  std::int64_t number_ = 0, event_number_ = 0;
  std::uint64_t time_ns_ = 0;  ///< of the recording: that of all steps together
  bool last_is_hashed_ = false;
  int pass_ = 0;
  ExerciseState exercise_state_ = ExerciseState::running;
  std::string mode_;
  std::array<double, 2> largest_force_N_{};  ///< of each hand on tissue since the last message
  std::int64_t hands_number_ = 0;
  int hands_left_ = 0;  ///< messages on hands that are kept until the next step
  PictureRecorder picture_;
  insula_lcm::session_step_t message_{};
  insula_lcm::sim_event_t event_{};
  std::vector<std::uint8_t> scratch_;

  std::mutex mutable mutex_;
  std::condition_variable wake_;
  mcap::Buffer waiting_;  ///< messages one after the other: channel, chunk, time, length, bytes
  std::string failure_;
  std::atomic<double> writer_cpu_s_ = 0;
  bool closing_ = false;
  std::thread thread_;
};

}  // namespace insula
