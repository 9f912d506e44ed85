// SPDX-License-Identifier: GPL-3.0-or-later
// Sends the results of a step: the haptic problem, the frame, events, and once a second the scene's state.
#pragma once
#include <cstdint>
#include <filesystem>
#include <insula_lcm/metrics_t.hpp>
#include <insula_lcm/render_frame_t.hpp>
#include <insula_lcm/scene_info_t.hpp>
#include <insula_lcm/soft_guide_t.hpp>

#include "core/bus/bus.h"
#include "core/haptics/condense.h"
#include "core/haptics/contact_frame_prediction.h"
#include "core/haptics/haptic_update.h"
#include "core/haptics/surface_patch_builder.h"
#include "core/sim/simulation.h"
#include "engine/live/cause_lines.h"
#include "engine/live/exchange_pause.h"
#include "engine/live/session_mode.h"
#include "engine/live/soft_guiding.h"

namespace insula {

/// Microseconds of CLOCK_MONOTONIC.
std::int64_t monotonic_us();

class Publisher {
 public:
  /// 200 rows of W in float32 are 80 KB. With the other fields, a message stays below 120 KB, which a default kernel
  /// transmits.
  static constexpr int max_rows = 200;
  /// Horizon for Simulation::set_collision_horizon(), in steps: the time until the next problem reaches the servo.
  static constexpr double collision_horizon_steps = 2;

  Publisher(Bus& bus, std::int64_t session, const std::filesystem::path& scene, const std::filesystem::path& bundle,
            const std::filesystem::path& motion, const std::string& title);

  /// After a step: problem, events, and a frame if one is due. pose_time_us: time stamp of the devices' poses in the
  /// step; 0: none.
  void step(const Simulation& simulation, std::int64_t pose_time_us = 0);
  /// Problem, and a frame if one is due, of the last step once more, while the run waits.
  void again(const Simulation& simulation, std::int64_t pose_time_us = 0);
  /// A soft guide that lasts, in each step.
  void guide(const HandGuiding& guiding);
  /// Events that belong to no step.
  void events(const std::vector<Event>& events);
  /// Sends only the frame, while paused.
  void paused_frame(const Simulation& simulation);
  /// Repeats the scene's state once a second, or at once when it has changed.
  void info(const std::string& state, const std::string& message = "");
  /// The motion that simulated hands follow from now on; empty: none. Sent at once with the next info().
  void follow(const std::filesystem::path& motion);
  /// Frames are sent at about this rate, whatever that of the steps.
  static constexpr double frames_a_second = 60;
  /// Metrics are sent at this interval, s of the clock.
  static constexpr double metrics_interval_s = 0.2;
  /// What frames say of the session from now on.
  void note(SessionNote note) { note_ = std::move(note); }
  std::int64_t failed() const { return failed_; }

 private:
  bool frame_is_due(const Simulation& simulation);
  void frame(const Simulation& simulation, bool paused);
  void metrics(const Simulation& simulation);

  Bus& bus_;
  std::int64_t session_, sequence_ = 0, event_sequence_ = 0, frame_sequence_ = 0, last_info_us_ = 0,
                         last_metrics_us_ = 0, failed_ = 0;
  insula_lcm::scene_info_t info_{};
  SessionNote note_;
  CauseLines causes_;
  int steps_since_frame_ = 0;
  insula_lcm::render_frame_t frame_{};
  insula_lcm::metrics_t metrics_{};
  insula_lcm::soft_guide_t guide_{};
  ProblemStamp stamp_;
  SurfacePatchBuilder add_patches_;
  ContactFramePrediction predict_frames_;
  Condenser condense_;
  ConstraintProblem condensed_;
  ExchangePause pause_;
  std::vector<std::uint8_t> scratch_;
};

}  // namespace insula
