// SPDX-License-Identifier: GPL-3.0-or-later
// Steps become messages; a thread puts them into the file.
#include "engine/session/session_recorder.h"

#include <fmt/chrono.h>
#include <spdlog/spdlog.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <ctime>
#include <nlohmann/json.hpp>

#include "core/base/input_error.h"
#include "core/bus/channels.h"
#include "core/bus/codec.h"
#include "engine/reports/exercise_outcome.h"
#include "engine/reports/metrics_report.h"
#include "engine/session/session_files.h"
#include "engine/session/session_format.h"
#include "engine/session/solver_devices.h"

namespace insula {
namespace {

// Inputs are written at least this often, so that a program that dies loses no more.
constexpr auto flush_period = std::chrono::milliseconds(500);
// What the engine needs again, what a timeline shows, and pictures are read apart.
constexpr std::size_t input_lane = 0, timeline_lane = 1, picture_lane = 2;
// Messages on hands between two steps: a fifth of a second of them.
constexpr int most_hands = 50;

std::string local_time() { return fmt::format("{:%Y-%m-%dT%H:%M:%S%z}", fmt::localtime(std::time(nullptr))); }

void fill(insula_lcm::step_input_t& to, const SimulationInput& from) {
  to.kind = std::int8_t(from.kind);
  to.index = from.index;
  to.present = from.hand.present;
  for (int i = 0; i < 3; ++i) to.p_m[i] = from.hand.device.p[i];
  const Quat& q = from.hand.device.q;
  to.q[0] = q.w();
  to.q[1] = q.x();
  to.q[2] = q.y();
  to.q[3] = q.z();
  to.button1 = from.hand.button1;
  to.button2 = from.hand.button2;
  to.verb = from.verb;
  to.argument = from.argument;
  to.seed = std::int64_t(from.seed);
  to.seconds = from.seconds;
}

}  // namespace

std::int64_t SessionRecorder::steps_a_second(double h) { return std::max<std::int64_t>(1, std::lround(1 / h)); }

SessionRecorder::SessionRecorder(const std::filesystem::path& file, const Simulation& simulation,
                                 const SessionAbout& about)
    : file_(file), out_(std::make_unique<McapWriter>(file, session::profile, session::library())), mode_(about.mode) {
  const SceneFileList files = list_scene_files(about.scene);
  mcap::Text text = {{"scene", about.scene.string()},
                     {"scene_file", files.scene},
                     {"scene_folder", files.root.string()},
                     {"title", simulation.scene().title()},
                     {"motion", about.motion},
                     {"mode", about.mode},
                     {"began", local_time()},
                     {"step_s", session::exact(simulation.h())},
                     {"instruction_set", session::instruction_set()},
                     {"start_hash", session::hex(simulation.state_hash())}};
  for (const auto& [name, value] : about.fields) text[session::field_prefix + name] = value;
  session::describe_solvers(simulation, text);
  if (const Complications* c = simulation.complications()) text["seed"] = std::to_string(c->drawn_from());
  out_->describe("session", text);
  put_scene_files(*out_, files);
  put_bundle(*out_, simulation);
  add_channels(simulation);
  waiting_.reserve(1u << 20);
  thread_ = std::thread([this] { write_until_closed(); });
}

void SessionRecorder::add_channels(const Simulation& simulation) {
  const auto schema = [&](const char* name) { return out_->add_schema(name, "lcm", session::schema_of(name)); };
  step_channel_ = out_->add_channel(session::step_topic, schema("session_step_t"), "lcm");
  event_channel_ = out_->add_channel(std::string(channel::sim_event), schema("sim_event_t"), "lcm", {}, timeline_lane);
  hands_channel_ = out_->add_channel(std::string(channel::device_state), schema("device_state_t"), "lcm");
  ticks_channel_ = out_->add_channel(std::string(channel::servo_ticks), schema("servo_ticks_t"), "lcm");
  metrics_channel_ = out_->add_channel(session::metrics_topic, 0, "json", {}, timeline_lane);
  channels_channel_ = out_->add_channel(session::channels_topic, 0, "json", {}, timeline_lane);
  forces_channel_ = out_->add_channel(session::hands_topic, 0, "json", {}, timeline_lane);
  review_channel_ = out_->add_channel(session::review_topic, 0, "json", {}, timeline_lane);
  frame_channel_ = out_->add_channel(session::frame_topic, schema("render_frame_t"), "lcm", {}, picture_lane);
  geometry_channel_ = out_->add_channel(session::geometry_topic, 0, session::geometry_encoding,
                                        {{"unit", session::exact(picture::unit)}}, picture_lane);
  mcap::Text names;
  for (const ChannelEntry& e : simulation.channels().entries())
    for (int k = 0; k < e.size(); ++k) {
      std::string name = e.size() == 1 ? e.id : fmt::format("{}.{}", e.id, "xyz"[k]);
      if (const std::string_view unit = e.channel->quantity().si; !unit.empty()) name += fmt::format(" {}", unit);
      names[fmt::format("{:04}", names.size())] = std::move(name);
    }
  out_->describe(session::channel_names, names);
  mcap::Text metrics;
  if (const Exercise* exercise = simulation.exercise())
    for (const MetricValue& m : exercise->metrics()) metrics[m.id] = m.text;
  out_->describe(session::metric_names, metrics);
}

SessionRecorder::~SessionRecorder() { finish(); }

void SessionRecorder::step(const Simulation& simulation) {
  ++number_;
  time_ns_ = std::uint64_t(std::llround(double(number_) * simulation.h() * 1e9));
  const std::int64_t a_second = steps_a_second(simulation.h());
  put_step(simulation, number_ % a_second == 0);
  put_events(simulation.events());
  if (simulation.steps() == 1) {
    ++pass_;
    exercise_state_ = ExerciseState::running;
    picture_.begin_again();
  }
  const Exercise* exercise = simulation.exercise();
  const bool ended = exercise && exercise->log().state() != exercise_state_;
  if (ended) exercise_state_ = exercise->log().state();
  if (ended || number_ % a_second == 0) put_metrics(simulation, ended);
  for (std::size_t hand = 0; hand < 2; ++hand)
    largest_force_N_[hand] = std::max(largest_force_N_[hand], simulation.report().hands[hand].contact_force);
  if (number_ % std::max<std::int64_t>(1, a_second / channels_a_second) == 0) {
    put_channels(simulation);
    put_hands(simulation);
  }
  if ((number_ - 1) % std::max<std::int64_t>(1, a_second / PictureRecorder::pictures_a_second) == 0)
    put_picture(simulation);
  hands_left_ = most_hands;
}

void SessionRecorder::hands(mcap::Bytes device_state) {
  // The servo's ticks have the poses and forces; buttons and names of devices need no 250 messages a second.
  if (hands_left_-- > 0 && hands_number_++ % kept_hands == 0) put(hands_channel_, device_state);
}

void SessionRecorder::ticks(mcap::Bytes servo_ticks) {
  if (hands_left_ > 0) put(ticks_channel_, servo_ticks);
}

void SessionRecorder::end_pass(const Simulation& simulation) {
  if (number_ > 0 && pass_ > 0) put_metrics(simulation, true);
}

void SessionRecorder::note(const std::vector<Event>& events) {
  for (const Event& e : events)
    if (e.kind == "mode") mode_ = e.id;
  put_events(events);
}

void SessionRecorder::put_text(std::uint16_t channel, const std::string& text) {
  put(channel, {reinterpret_cast<const std::uint8_t*>(text.data()), text.size()});
}

void SessionRecorder::put_metrics(const Simulation& simulation, bool last_of_pass) {
  const Exercise* exercise = simulation.exercise();
  if (!exercise) return;
  nlohmann::ordered_json values = nlohmann::ordered_json::array();
  for (const MetricValue& m : exercise->metrics())
    if (m.known) values.push_back(metric_json(m));
  const nlohmann::ordered_json message = {{"number", number_},
                                          {"time_s", simulation.time()},
                                          {"pass", pass_},
                                          {"mode", mode_},
                                          {"state", state_name(exercise->log().state())},
                                          {"last_of_pass", last_of_pass},
                                          {"metrics", std::move(values)}};
  put_text(metrics_channel_, message.dump());
}

/// [time in s, values in SI in the order of the description; null: not known].
void SessionRecorder::put_channels(const Simulation& simulation) {
  std::string text = fmt::format("[{:.4f}", simulation.time());
  for (const double v : simulation.report().channels) text += std::isfinite(v) ? fmt::format(",{:.6g}", v) : ",null";
  put_text(channels_channel_, text + "]");
}

/// [time in s, largest force of the left and of the right hand on tissue since the last message in N, distance of the
/// tips in m]; null: no such hand.
void SessionRecorder::put_hands(const Simulation& simulation) {
  const auto& hands = simulation.report().hands;
  std::string text = fmt::format("[{:.4f}", simulation.time());
  for (std::size_t hand = 0; hand < 2; ++hand)
    text += hands[hand].present ? fmt::format(",{:.6g}", largest_force_N_[hand]) : ",null";
  const bool both = hands[0].present && hands[1].present;
  text += both ? fmt::format(",{:.6g}]", (hands[0].tip.p - hands[1].tip.p).norm()) : ",null]";
  put_text(forces_channel_, text);
  largest_force_N_ = {};
}

void SessionRecorder::put_picture(const Simulation& simulation) {
  if (!simulation.report().finite) return;
  // A run without persons has another word for its mode.
  picture_.take(simulation, session_mode(mode_).value_or(SessionMode::demonstration));
  put(frame_channel_, picture_.frame(), picture_.key());
  put(geometry_channel_, picture_.geometry());
}

void SessionRecorder::put_events(const std::vector<Event>& events) {
  for (const Event& e : events) {
    event_.sequence = ++event_number_;
    event_.sim_time_s = std::max(0.0, e.time);
    event_.kind = e.kind;
    event_.id = e.id;
    event_.text = e.text;
    event_.value = e.value;
    event_.hand = std::int8_t(e.hand);
    if (encode(event_, scratch_)) put(event_channel_, scratch_);
  }
}

void SessionRecorder::put_step(const Simulation& simulation, bool hashed) {
  insula_lcm::session_step_t& m = message_;
  m.number = number_;
  m.sim_time_s = std::max(0.0, simulation.time());
  m.hashed = hashed && simulation.report().finite;
  m.state_hash = 0;
  m.energy_J = 0;
  m.body_sum.clear();
  if (m.hashed) {
    m.state_hash = std::int64_t(simulation.state_hash());
    m.energy_J = simulation.energy();
    simulation.body_sums(m.body_sum);
  }
  m.bodies = std::int32_t(m.body_sum.size());
  last_is_hashed_ = m.hashed;
  const std::vector<SimulationInput>& inputs = simulation.inputs();
  m.inputs = std::int32_t(inputs.size());
  m.input.resize(inputs.size());
  for (std::size_t i = 0; i < inputs.size(); ++i) fill(m.input[i], inputs[i]);
  if (encode(m, scratch_)) put(step_channel_, scratch_);
}

void SessionRecorder::put(std::uint16_t channel, mcap::Bytes message, bool first_of_chunk) {
  const std::lock_guard lock(mutex_);
  if (!failure_.empty() || closing_) return;
  if (waiting_.size() > most_waiting_bytes) {
    fail("the disk does not take the recording fast enough");
    return;
  }
  mcap::Put(waiting_).number(channel).number(std::uint8_t(first_of_chunk)).number(time_ns_);
  mcap::Put(waiting_).number(std::uint64_t(message.size())).raw(message);
}

/// Called with the mutex held.
void SessionRecorder::fail(const std::string& why) {
  failure_ = why;
  spdlog::error("the recording has ended: {}", why);
}

void SessionRecorder::write_until_closed() {
  mcap::Buffer taken;
  taken.reserve(1u << 20);
  auto flushed = std::chrono::steady_clock::now();
  for (bool last = false; !last;) {
    {
      std::unique_lock lock(mutex_);
      wake_.wait_for(lock, flush_period / 5, [this] { return closing_; });
      taken.swap(waiting_);
      last = closing_ || !failure_.empty();
    }
    try {
      mcap::Take t(taken);
      while (t.left() > 0) {
        const auto channel = t.number<std::uint16_t>();
        if (t.number<std::uint8_t>() != 0) {
          out_->flush(picture_lane);
          out_->flush(timeline_lane);
        }
        const auto time_ns = t.number<std::uint64_t>();
        out_->write(channel, time_ns, t.raw(t.number<std::uint64_t>()));
      }
      if (last) {
        out_->close();
      } else if (const auto now = std::chrono::steady_clock::now(); now - flushed > flush_period) {
        out_->flush(input_lane);
        flushed = now;
      }
    } catch (const InputError& e) {
      const std::lock_guard lock(mutex_);
      fail(e.what());
      last = true;
    }
    taken.clear();
    timespec used{};
    ::clock_gettime(CLOCK_THREAD_CPUTIME_ID, &used);
    writer_cpu_s_ = double(used.tv_sec) + 1e-9 * double(used.tv_nsec);
  }
}

void SessionRecorder::close(const Simulation& simulation) {
  // The last step once more with its hash, unless it has it.
  if (number_ > 0 && !last_is_hashed_ && thread_.joinable()) put_step(simulation, true);
  if (thread_.joinable()) end_pass(simulation);
  finish();
}

void SessionRecorder::finish() {
  if (!thread_.joinable()) return;
  {
    const std::lock_guard lock(mutex_);
    closing_ = true;
  }
  wake_.notify_all();
  thread_.join();
}

std::string SessionRecorder::failure() const {
  const std::lock_guard lock(mutex_);
  return failure_;
}

}  // namespace insula
