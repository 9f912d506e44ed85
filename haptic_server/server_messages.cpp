// SPDX-License-Identifier: GPL-3.0-or-later
// The haptic server's messages: incoming ones on the receiving thread, outgoing ones on the publishing thread.
#include <spdlog/spdlog.h>

#include <algorithm>
#include <utility>

#include "core/haptics/haptic_update.h"
#include "haptic_server/server.h"

namespace insula {
namespace {

/// A step that ended this far in the future has the time stamp of another clock.
constexpr std::int64_t future_us = 20'000;

void copy3(const Vec3& from, double* to) { std::copy_n(from.data(), 3, to); }

}  // namespace

int HapticServer::receive(int timeout_ms) { return bus_.poll(timeout_ms); }

void HapticServer::refuse(const std::string& channel, const std::string& why) {
  // Reported once for each power of ten, so that many invalid messages do not give many lines.
  const std::int64_t n = refused_.fetch_add(1, std::memory_order_relaxed) + 1;
  if (n == 1 || n == 10 || n == 100 || n % 1000 == 0)
    spdlog::warn("{}: message refused ({} in all): {}", channel, n, why);
}

void HapticServer::on_problem(Bytes bytes) {
  Received& slot = problems_.back();
  if (!decode_problem(bytes, slot.update, why_)) return refuse("HAPTIC_PROBLEM", why_);
  const HapticUpdate& u = slot.update;
  const std::int64_t now = clock_.now_ns();
  if (u.problem.rows > servo_max_rows) return refuse("HAPTIC_PROBLEM", "too many rows");
  if (u.time_us > now / 1000 + future_us) return refuse("HAPTIC_PROBLEM", "stamped with a time to come");
  if (!order_.take(u.session, u.sequence, now)) return;
  slot.receive_ns = now;
  received_.fetch_add(1, std::memory_order_relaxed);
  problems_.publish();
}

void HapticServer::on_scene(Bytes bytes) {
  if (!decode(bytes, scene_info_, why_)) return refuse("SCENE_INFO", why_);
  const auto& info = scene_info_;
  if (info.session < order_.session()) return;  // from an engine that was replaced
  // The bundle may be incomplete until the scene runs.
  const std::string key = std::to_string(info.session) + "\n" + info.motion + "\n" + info.bundle + "\n" +
                          (info.state == "loading" || info.state == "error" ? info.state : "ready");
  if (key == setup_key_ || info.state == "error") return;
  setup_key_ = key;
  if (info.state == "loading") return;
  auto setup = std::make_unique<SceneSetup>(read_scene_setup(info.session, info.motion, info.bundle));
  if (!setup->problem.empty()) spdlog::warn("{}", setup->problem);
  spdlog::info("scene \"{}\": {}", info.title.empty() ? info.scene : info.title,
               setup->motion.empty() ? std::string("no scripted motion") : "hands follow " + info.motion);
  remark_.set(setup->problem);
  setups_.give(std::move(setup));
}

void HapticServer::on_input(Bytes bytes) {
  if (!decode(bytes, hand_input_, why_)) return refuse("HAND_INPUT", why_);
  const auto& m = hand_input_;
  Wish& wish = wishes_[m.hand == 1 ? 1 : 0];
  wish.sample.pose.p = Vec3(m.p_m[0], m.p_m[1], m.p_m[2]);
  wish.sample.pose.q = Quat(m.q[0], m.q[1], m.q[2], m.q[3]).normalized();
  wish.sample.button1 = m.button1 != 0;
  wish.sample.button2 = m.button2 != 0;
  wish.released = false;
  ++wish.count;
  inputs_.back() = wishes_;
  inputs_.publish();
}

void HapticServer::on_command(Bytes bytes) {
  if (!decode(bytes, command_, why_)) return refuse("USER_COMMAND", why_);
  if (command_.command != "release") return;
  for (std::size_t i = 0; i < 2; ++i) {
    if (command_.argument != (i == 0 ? "right" : "left")) {  // without an argument: both hands
      wishes_[i].released = true;
      ++wishes_[i].count;
    }
  }
  inputs_.back() = wishes_;
  inputs_.publish();
}

void HapticServer::on_event(Bytes bytes) {
  if (!decode(bytes, event_, why_)) return refuse("SIM_EVENT", why_);
  if (event_.session != order_.session()) return;
  const bool severed = event_.kind == "strand_cut" || event_.kind == "strand_torn";
  if (!severed && event_.kind != "clip_shut") return;
  // A strand that tears without a blade gives a transient to both hands.
  for (std::size_t i = 0; i < 2; ++i)
    if (event_.hand < 0 || std::size_t(event_.hand) == i)
      (severed ? severed_ : shut_)[i].fetch_add(1, std::memory_order_relaxed);
}

void HapticServer::on_guide(Bytes bytes) {
  if (!decode(bytes, guide_, why_)) return refuse("SOFT_GUIDE", why_);
  const auto& m = guide_;
  const std::int64_t now = clock_.now_ns(), age_us = now / 1000 - m.time_us;
  if (age_us < -future_us) return refuse("SOFT_GUIDE", "stamped with a time to come");
  if (age_us > std::int64_t(SoftGuide::stale_after_s * 1e6)) return;  // late
  if (m.session != order_.session() || !guide_order_.take(m.session, m.sequence, now)) return;
  const Vec3 direction = Vec3(m.direction[0], m.direction[1], m.direction[2]).normalized();
  guide_wishes_[m.hand == 1 ? 1 : 0] = {m.session, m.number, now, m.hand, direction, m.force_N, m.duration_s};
  guides_.back() = guide_wishes_;
  guides_.publish();
}

bool HapticServer::publish_state() {
  if (!snapshots_.update()) return false;
  const Snapshot& s = snapshots_.front();
  state_.session = run_;
  state_.sequence = ++state_sequence_;
  state_.time_us = s.time_ns / 1000;
  state_.hands = 2;
  state_.hand.resize(2);
  for (std::size_t i = 0; i < 2; ++i) {
    insula_lcm::hand_state_t& h = state_.hand[i];
    const DeviceReading& r = s.reading[i];
    h.hand = std::int8_t(i);
    h.device = hands_[i].device->profile().name;
    h.connected = r.connected;
    copy3(r.pose.p, h.p_m);
    h.q[0] = r.pose.q.w();
    copy3(r.pose.q.vec(), h.q + 1);
    copy3(r.v, h.v_m_s);
    copy3(r.w, h.w_rad_s);
    h.button1 = r.button1;
    h.button2 = r.button2;
    copy3(s.force[i], h.force_N);
    copy3(s.torque[i], h.torque_Nm);
  }
  return publish(bus_, channel::device_state, state_, scratch_);
}

void HapticServer::collect() {
  TickSample sample;
  while (samples_.pop(sample)) {
    collector_.add(sample);
    add_tick(sample);
  }
}

void HapticServer::add_tick(const TickSample& sample) {
  if (ticks_.ticks == 0) ticks_.time_us = sample.time_us;
  ++ticks_.ticks;
  ticks_.numbers += numbers_of_tick;
  ticks_.after_us.push_back(std::int32_t(sample.time_us - ticks_.time_us));
  for (const TickSample::Hand& hand : sample.hand) {
    ticks_.hands.insert(ticks_.hands.end(), hand.p_m.begin(), hand.p_m.end());
    ticks_.hands.insert(ticks_.hands.end(), hand.q.begin(), hand.q.end());
    ticks_.hands.insert(ticks_.hands.end(), hand.force_N.begin(), hand.force_N.end());
  }
  if (ticks_.ticks < ticks_of_message) return;
  ticks_.session = run_;
  ticks_.sequence = ++ticks_sequence_;
  publish(bus_, channel::servo_ticks, ticks_, scratch_);
  ticks_.ticks = ticks_.numbers = 0;
  ticks_.after_us.clear();
  ticks_.hands.clear();
}

std::string HapticServer::note(double age_ms) const {
  if (stopping_.load(std::memory_order_relaxed)) return "stopping";
  if (age_ms < 0) return "waiting for an engine";
  if (age_ms > SafetyGate::stale_after_s * 1e3) return "no new problem from the engine: forces are off";
  const Snapshot& s = snapshots_.front();
  for (std::size_t i = 0; i < 2; ++i) {
    const std::string remark = hands_[i].device->remark();
    if (!remark.empty()) return (i == 0 ? "left: " : "right: ") + remark;
  }
  for (std::size_t i = 0; i < 2; ++i)
    if (!s.in_range[i])
      return std::string(i == 0 ? "left" : "right") + " device too far from where the engine has it: its force is off";
  if (std::string remark = remark_.text(); !remark.empty()) return remark;
  const std::string late = budget_advice(status_, options_.period_s * 1e6, missed_now_);
  return late.empty() ? options_.advice : late;
}

const insula_lcm::haptic_status_t& HapticServer::publish_status() {
  collect();
  const std::int64_t now = clock_.now_ns();
  collector_.finish(double(now - status_start_ns_) * 1e-9, status_);
  status_start_ns_ = now;
  status_.session = run_;
  status_.sequence = ++status_sequence_;
  status_.time_us = now / 1000;
  const std::int64_t missed = missed_.load(std::memory_order_relaxed);
  missed_now_ = missed - status_.missed_ticks;
  status_.missed_ticks = missed;
  const Snapshot& s = snapshots_.front();
  status_.problem_age_ms = s.receive_ns == 0 ? -1 : double(std::max<std::int64_t>(0, now - s.receive_ns)) * 1e-6;
  status_.problems_received = received_.load(std::memory_order_relaxed);
  status_.messages_refused = refused_.load(std::memory_order_relaxed);
  status_.force_scale = s.force_scale;
  status_.realtime = options_.realtime;
  status_.note = note(status_.problem_age_ms).substr(0, 500);
  publish(bus_, channel::haptic_status, status_, scratch_);
  return status_;
}

}  // namespace insula
