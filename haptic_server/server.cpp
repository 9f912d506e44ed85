// SPDX-License-Identifier: GPL-3.0-or-later
// The part of the haptic server that runs in the servo thread.
#include "haptic_server/server.h"
#include "core/haptics/haptic_update.h"

#include <algorithm>
#include <cmath>

namespace insula {
namespace {

constexpr double longest_arm_step_s = 0.02;
constexpr double longest_age_s = 0.2;  // largest age of a problem for which tissue is extrapolated
/// Simulated time up to which a scene counts as just started.
constexpr double beginning_s = 0.25;

bool finite(const Pose& pose) {
  return pose.p.allFinite() && pose.q.coeffs().allFinite() && std::abs(pose.q.squaredNorm() - 1) < 1e-3;
}

/// Whether a reading is valid for DEVICE_STATE. A device with an invalid reading counts as disconnected. One hand's
/// error must not make the engine refuse the message, which also has the other hand's reading.
bool sound(const DeviceReading& r) {
  const double q[4] = {r.pose.q.w(), r.pose.q.x(), r.pose.q.y(), r.pose.q.z()};
  return within(r.pose.p.data(), 3, limits::position_m) && unit_quaternion(q) &&
         within(r.v.data(), 3, limits::speed_m_s) && within(r.w.data(), 3, limits::spin_rad_s);
}

/// The device pose for which the problem was built. False if it has no tool of this hand.
bool device_in_problem(const HapticUpdate& update, int hand, Pose& pose) {
  for (std::size_t t = 0; t < update.problem.tools.size() && t < 2; ++t) {
    const ToolTerms& tool = update.problem.tools[t];
    if (tool.hand != hand) continue;
    pose.q = tool.device.q * update.offset[t].q.conjugate();
    pose.p = tool.device.p - pose.q * update.offset[t].p;
    return true;
  }
  return false;
}

}  // namespace

HapticServer::Hand::Hand(DeviceChoice choice)
    : device(std::move(choice.device)), source(choice.source), gate(device->profile()) {}

HapticServer::HapticServer(Bus& bus, std::array<DeviceChoice, 2> devices, const Clock& clock, ServerOptions options)
    : bus_(bus),
      clock_(clock),
      options_(std::move(options)),
      run_(clock.now_ns() / 1000),
      servo_(options_.servo),
      hands_{Hand(std::move(devices[0])), Hand(std::move(devices[1]))},
      status_start_ns_(clock.now_ns()) {
  bus_.subscribe(channel::haptic_problem, [this](Bytes b) { on_problem(b); });
  bus_.subscribe(channel::scene_info, [this](Bytes b) { on_scene(b); });
  bus_.subscribe(channel::hand_input, [this](Bytes b) { on_input(b); });
  bus_.subscribe(channel::sim_event, [this](Bytes b) { on_event(b); });
  bus_.subscribe(channel::soft_guide, [this](Bytes b) { on_guide(b); });
  bus_.subscribe(channel::user_command, [this](Bytes b) { on_command(b); });
}

const Motion* HapticServer::motion() const noexcept {
  if (options_.motion) return &*options_.motion;
  return setup_ && setup_->session == session_ ? &setup_->motion : nullptr;
}

void HapticServer::take_problem(std::int64_t now) noexcept {
  if (!problems_.pending()) return;
  servo_.set_problem(nullptr);  // keeps the solution; the receiving thread may use the old problem's memory again
  problems_.update();
  const Received& r = problems_.front();
  const HapticUpdate& u = r.update;
  const bool new_session = !has_problem_ || u.session != session_;
  const bool back_in_time = !new_session && u.sim_time_s < last_sim_time_ - 1e-9;
  if (new_session || back_in_time) {
    servo_.reset();
    session_ = u.session;
    session_start_ns_ = now;
    fresh_start_ = u.sim_time_s < beginning_s;
    motion_clock_.reset(u.sim_time_s);
    for (Hand& hand : hands_) {
      hand.to_be_laid = true;
      hand.placed = hand.placed && !hand.device->simulated();
    }
  }
  const std::int64_t posed = u.pose_time_us > 0 ? u.pose_time_us : u.time_us;
  servo_.set_problem(&u.problem, u.offset, std::clamp(double(now / 1000 - posed) * 1e-6, 0.0, longest_age_s));
  if (u.sim_time_s > last_sim_time_ || new_session || back_in_time) motion_clock_.step_arrived(u.sim_time_s, u.step_s);
  last_sim_time_ = u.sim_time_s;
  has_problem_ = true;
}

void HapticServer::take_wishes() noexcept {
  inputs_.update();
  for (std::size_t i = 0; i < 2; ++i) {
    const Wish& wish = inputs_.front()[i];
    Hand& hand = hands_[i];
    if (wish.count == hand.wishes_seen) continue;
    hand.wishes_seen = wish.count;
    if (!hand.placed || hand.source == HandSource::person) continue;
    if (wish.released) hand.guide.release();
    else hand.guide.take_over(wish.sample);
  }
}

void HapticServer::place_hands(std::int64_t now) noexcept {
  if (!has_problem_) return;
  const HapticUpdate& update = problems_.front().update;
  const bool setup_known = setup_ && setup_->session == session_;
  if (!setup_known && double(now - session_start_ns_) * 1e-9 < setup_patience_s) return;
  for (std::size_t i = 0; i < 2; ++i) {
    Hand& hand = hands_[i];
    if (hand.placed && !(hand.to_be_laid && setup_known)) continue;
    Pose here;
    const bool in_problem = device_in_problem(update, int(i), here);
    const bool has_home = setup_known && setup_->has_home[i];
    if (!in_problem && !has_home) continue;  // the scene has no such hand
    hand.home.pose = has_home ? setup_->home[i] : here;
    hand.device->face(setup_known ? setup_->person_to_scene : Quat::Identity());
    const Motion* script = hand.source == HandSource::motion_or_viewer ? motion() : nullptr;
    if (script && !script->has(int(i))) script = nullptr;
    Pose start = hand.home.pose;
    if (script) start = script->at(int(i), motion_clock_.time()).pose;
    // A real arm stays where its user holds it. Only its frame is placed, always at the same position.
    if (!fresh_start_ && in_problem && hand.device->simulated()) start = here;
    if (!finite(start)) continue;
    Vec3 centre, extent;
    lay_workspace(script, int(i), hand.home.pose.p, hand.device->profile().workspace_m, centre, extent);
    hand.device->place(start, centre, extent);
    hand.guide.place(start);
    hand.placed = true;
    hand.to_be_laid = false;
  }
}

bool HapticServer::live(const ServoHand& hand, std::int64_t now) const noexcept {
  if (stopping_.load(std::memory_order_relaxed) || !last_.solved || !hand.valid) return false;
  const Received& r = problems_.front();
  const std::int64_t stale_ns = std::int64_t(SafetyGate::stale_after_s * 1e9);
  // The age counts from arrival and from the engine's own time stamp, so that a delayed queue does not count as a live
  // engine. An arrival in the future means that the clock went back, and the age is unknown.
  const std::int64_t age = now - r.receive_ns;
  return age >= 0 && age <= stale_ns && now - r.update.time_us * 1000 <= stale_ns;
}

// Computes the output force from the servo's force, with transients, for the gate.
Vec3 HapticServer::force_output(std::size_t i, double dt, bool alive) noexcept {
  Hand& hand = hands_[i];
  const Vec3& force = last_.hand[i].force;
  const int severed = severed_[i].load(std::memory_order_relaxed), shut = shut_[i].load(std::memory_order_relaxed);
  if (alive) {
    const Vec3 along = force.isZero(0) ? hand.reading.v : force;
    if (hand.onset.met(dt, force.norm()) && servo_.problem())
      hand.force_output.start_transient(force, impact_transient(-hand.reading.v.dot(force.normalized()),
                                                                hardness(*servo_.problem(), int(i), servo_.lambda())));
    if (severed != hand.severed_seen) hand.force_output.start_transient(along, severing_transient);
    if (shut != hand.shut_seen) hand.force_output.start_transient(along, latching_transient);
  }
  hand.severed_seen = severed;
  hand.shut_seen = shut;
  if (setup_ && setup_->session == session_) {
    ForceOutputSettings settings = hand.force_output.settings();
    settings.force_scale = setup_->force_scale;
    hand.force_output.set(settings);
  }
  const Vec3 up = (setup_ ? setup_->person_to_scene : Quat::Identity()) * Vec3(Vec3::UnitZ());
  return hand.force_output.apply(hand.device->profile(), dt, force, hand.reading.v, up, alive);
}

// The soft force of a guide, which the gate takes with all others.
Vec3 HapticServer::soft_guide(std::size_t i, double dt, bool alive, std::int64_t now) noexcept {
  Hand& hand = hands_[i];
  const GuideWish& wish = guides_.front()[i];
  const std::int64_t age = now - wish.receive_ns;
  const bool fresh = wish.session == session_ && age >= 0 && age <= std::int64_t(SoftGuide::stale_after_s * 1e9);
  if (fresh && alive) hand.soft_guide.take(wish);
  hand.guided = hand.soft_guide.advance(dt, fresh, alive, hand.reading.pose.p);
  return hand.guided;
}

namespace {
TickSample::Hand sample_of(const Pose& device, const Vec3& force) noexcept {
  const Eigen::Vector3f p = device.p.cast<float>(), f = force.cast<float>();
  const Eigen::Quaternionf q = device.q.cast<float>();
  return {{p.x(), p.y(), p.z()}, {q.w(), q.x(), q.y(), q.z()}, {f.x(), f.y(), f.z()}};
}
}  // namespace

// Sends this tick's forces through the gates. True if all of them are zero.
bool HapticServer::send_forces(double dt, std::int64_t now, TickSample& sample) noexcept {
  bool quiet = true;
  for (std::size_t i = 0; i < 2; ++i) {
    Hand& hand = hands_[i];
    const ServoHand& wanted = last_.hand[i];
    const bool alive = live(wanted, now);
    // What a guide gives is bounded by itself, and is no sign of a contact that is not passive.
    hand.energy.observe(hand.gate.force() - hand.guided, hand.reading.pose.p);
    const Vec3 force = force_output(i, dt, alive) + soft_guide(i, dt, alive, now);
    hand.gate.apply(dt, alive, force, hand.force_output.settings().force_scale * wanted.torque);
    sample.given_J[i] = float(hand.energy.given());
    hand.device->write(hand.gate.force(), hand.gate.torque());
    sample.fresh[i] = alive && wanted.force != hand.last_force;
    hand.last_force = wanted.force;
    sample.hand[i] = sample_of(hand.reading.pose, hand.gate.force());
    quiet = quiet && hand.gate.force().isZero(0) && hand.gate.torque().isZero(0);
  }
  return quiet;
}

void HapticServer::tick(std::int64_t due_ns, std::int64_t missed) noexcept {
  const std::int64_t now = clock_.now_ns();
  const double dt = last_tick_ns_ == 0 ? options_.period_s : double(now - last_tick_ns_) * 1e-9;
  last_tick_ns_ = now;
  missed_.fetch_add(missed, std::memory_order_relaxed);
  TickSample sample;
  sample.time_us = now / 1000;
  sample.lateness_us = float(std::max<std::int64_t>(0, now - due_ns)) * 1e-3f;

  setup_ = setups_.take();
  take_problem(now);
  place_hands(now);
  take_wishes();
  guides_.update();

  const double arm_dt = std::clamp(dt, 0.0, longest_arm_step_s);
  const double script_time = motion_clock_.advance(arm_dt);
  ServoInput input;
  input.dt_s = arm_dt;
  for (std::size_t i = 0; i < 2; ++i) {
    Hand& hand = hands_[i];
    if (hand.placed) {
      const Motion* script = hand.source == HandSource::motion_or_viewer ? motion() : nullptr;
      const HandSample wish = script && script->has(int(i)) ? script->at(int(i), script_time) : hand.home;
      hand.device->guide(hand.guide.advance(arm_dt, wish));
      hand.device->advance(arm_dt);
    }
    hand.reading = hand.device->read();
    if (!sound(hand.reading)) hand.reading = DeviceReading{};
    // An arm that waits for its frame has no valid pose.
    if (!hand.placed) hand.reading.connected = false;
    input.device[i] = hand.reading.pose;
    input.connected[i] = hand.reading.connected;
  }

  const std::int64_t before = clock_.now_ns();
  last_ = servo_.tick(input);
  sample.solve_us = float(clock_.now_ns() - before) * 1e-3f;
  sample.solved = last_.solved;
  sample.sweeps = std::int16_t(last_.stats.sweeps);
  sample.rows = std::int16_t(last_.rows);
  sample.residual_m = float(last_.stats.residual_m);

  const bool quiet = send_forces(dt, now, sample);
  quiet_.store(quiet, std::memory_order_relaxed);
  samples_.push(sample);
  leave_snapshot(now);
}

void HapticServer::leave_snapshot(std::int64_t now) noexcept {
  Snapshot& s = snapshots_.back();
  s.time_ns = now;
  s.receive_ns = has_problem_ ? problems_.front().receive_ns : 0;
  s.force_scale = hands_[0].force_output.settings().force_scale;
  for (std::size_t i = 0; i < 2; ++i) {
    s.reading[i] = hands_[i].reading;
    s.force[i] = hands_[i].gate.force();
    s.torque[i] = hands_[i].gate.torque();
    // While a tool is exchanged, the problem has none for its hand. This is not out of range.
    Pose none;
    s.in_range[i] = !last_.solved || !hands_[i].reading.connected || last_.hand[i].valid ||
                    !device_in_problem(problems_.front().update, int(i), none);
  }
  snapshots_.publish();
}

}  // namespace insula
