// SPDX-License-Identifier: GPL-3.0-or-later
// Messages of the engine.
#include "engine/live/publisher.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <insula_lcm/sim_event_t.hpp>

#include "core/bus/channels.h"
#include "core/bus/codec.h"
#include "core/haptics/haptic_update.h"
#include "engine/live/frame.h"
#include "engine/reports/metrics_report.h"

namespace insula {

std::int64_t monotonic_us() {
  return std::chrono::duration_cast<std::chrono::microseconds>(std::chrono::steady_clock::now().time_since_epoch())
      .count();
}

Publisher::Publisher(Bus& bus, std::int64_t session, const std::filesystem::path& scene,
                     const std::filesystem::path& bundle, const std::filesystem::path& motion, const std::string& title)
    : bus_(bus), session_(session) {
  info_.session = session;
  info_.scene = scene.string();
  info_.bundle = bundle.string();
  info_.motion = motion.string();
  info_.title = title;
}

void Publisher::info(const std::string& state, const std::string& message) {
  const std::int64_t now = monotonic_us();
  if (now - last_info_us_ < 1'000'000 && info_.state == state && info_.message == message) return;
  last_info_us_ = now;
  info_.time_us = now;
  info_.state = state;
  info_.message = message;
  if (!publish(bus_, channel::scene_info, info_, scratch_)) ++failed_;
}

void Publisher::follow(const std::filesystem::path& motion) {
  info_.motion = motion.string();
  last_info_us_ = 0;
}

void Publisher::step(const Simulation& simulation, std::int64_t pose_time_us) {
  again(simulation, pose_time_us);
  events(simulation.events());
  add_patches_.compute_modes();
}

void Publisher::again(const Simulation& simulation, std::int64_t pose_time_us) {
  stamp_.session = session_;
  stamp_.sequence = ++sequence_;
  stamp_.time_us = monotonic_us();
  stamp_.pose_time_us = pose_time_us;
  stamp_.step_s = simulation.h();
  stamp_.sim_time_s = simulation.time();
  const double until_rendered_s = std::min(1e-3 * simulation.report().step_ms, simulation.h());  // approximately
  const ConstraintProblem& problem = condense_(
      predict_frames_(simulation, add_patches_(simulation, max_rows), until_rendered_s), max_rows, condensed_);
  if (!encode_problem(stamp_, problem, pause_.hands(simulation), scratch_) ||
      !bus_.publish(channel::haptic_problem, scratch_))
    ++failed_;
  if (frame_is_due(simulation)) frame(simulation, false);
}

bool Publisher::frame_is_due(const Simulation& simulation) {
  const int every = std::max(1, int(std::lround(1 / (frames_a_second * simulation.h()))));
  if (frame_sequence_ > 0 && ++steps_since_frame_ < every) return false;
  steps_since_frame_ = 0;
  return true;
}

void Publisher::events(const std::vector<Event>& events) {
  for (const Event& e : events) {
    insula_lcm::sim_event_t m{};
    m.session = session_;
    m.sequence = ++event_sequence_;
    m.time_us = monotonic_us();
    m.sim_time_s = e.time;
    m.kind = e.kind;
    m.id = e.id;
    m.text = e.text;
    m.value = e.value;
    m.hand = std::int8_t(e.hand);
    if (!publish(bus_, channel::sim_event, m, scratch_)) ++failed_;
  }
}

void Publisher::guide(const HandGuiding& guiding) {
  guide_.session = session_;
  ++guide_.sequence;
  guide_.time_us = monotonic_us();
  guide_.number = guiding.number;
  guide_.hand = std::int8_t(guiding.hand);
  for (int k = 0; k < 3; ++k) guide_.direction[k] = guiding.direction[k];
  guide_.force_N = SoftGuiding::force_N;
  guide_.duration_s = SoftGuiding::duration_s;
  if (!publish(bus_, channel::soft_guide, guide_, scratch_)) ++failed_;
}

void Publisher::paused_frame(const Simulation& simulation) { frame(simulation, true); }

void Publisher::frame(const Simulation& simulation, bool paused) {
  fill_frame(simulation, frame_, note_, &causes_);
  frame_.session = session_;
  frame_.sequence = ++frame_sequence_;
  frame_.time_us = monotonic_us();
  frame_.paused = paused;
  if (!publish(bus_, channel::render_frame, frame_, scratch_)) ++failed_;
  metrics(simulation);
}

void Publisher::metrics(const Simulation& simulation) {
  const Exercise* exercise = simulation.exercise();
  if (!exercise || frame_.time_us - last_metrics_us_ < std::int64_t(1e6 * metrics_interval_s)) return;
  last_metrics_us_ = frame_.time_us;
  metrics_.session = session_;
  metrics_.time_us = frame_.time_us;
  metrics_.sim_time_s = std::max(0.0, simulation.time());
  metrics_.at_end = exercise->log().state() != ExerciseState::running;
  metrics_.json =
      metrics_json(exercise->metrics(), false).dump(-1, ' ', false, nlohmann::ordered_json::error_handler_t::replace);
  if (!publish(bus_, channel::metrics, metrics_, scratch_)) ++failed_;
}

}  // namespace insula
