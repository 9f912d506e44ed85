// SPDX-License-Identifier: GPL-3.0-or-later
// Converts deflections to the goal of a simulated hand.
#include "haptic_server/devices/rate_device.h"

#include <algorithm>
#include <cmath>

namespace insula {
namespace {

ArmParameters arm_named(const std::string& name, int hand) {
  ArmParameters p;
  p.profile = omni_profile();
  p.profile.name = name;
  // As for `simulated`: a resting hand does not appear frozen.
  p.tremor_m = 40e-6;
  p.tremor_rad = 0.3e-3;
  p.tremor_seed = hand;
  return p;
}

void shorten(Vec3& v, double limit) {
  const double length = v.norm();
  if (length > limit) v *= limit / length;
}

}  // namespace

RateDevice::RateDevice(const std::string& name, int hand, const DeviceCalibration& calibration,
                       const RateSettings& settings)
    : calibration_(calibration), settings_(settings), arm_(arm_named(name, hand)) {}

bool RateDevice::fresh() noexcept {
  samples_.update();
  const RateSample& s = samples_.front();
  return s.valid && clock_.now_ns() - s.time_ns <= std::int64_t(stale_after_s * 1e9);
}

DeviceReading RateDevice::read() noexcept {
  DeviceReading r = arm_.read();
  if (!fresh()) return DeviceReading{};
  r.button1 = samples_.front().button1;
  r.button2 = samples_.front().button2;
  return r;
}

void RateDevice::place(const Pose& pose, const Vec3& centre, const Vec3& extent) noexcept {
  placed_at_ = pose;
  goal_ = HandGoal{};
  goal_.pose = pose;
  goal_.stops = false;
  arm_.place(pose, centre, extent);
}

void RateDevice::advance(double dt) noexcept {
  if (!(dt > 0)) return;
  Vec3 v = Vec3::Zero(), w = Vec3::Zero();
  if (fresh()) {
    const Mat3 turn = person_to_scene_.toRotationMatrix() * calibration_.axes;
    v = calibration_.scale * settings_.speed_m_s * (turn * samples_.front().v);
    w = settings_.spin_rad_s * (turn * samples_.front().w);
  }
  const Pose before = goal_.pose;
  const Pose& arm = arm_.arm().pose();
  Vec6 swept;
  swept << dt * v, dt * w;
  Pose goal = displaced(before, swept);
  Vec3 from_home = goal.p - placed_at_.p;
  shorten(from_home, settings_.reach_m);
  // If tissue or a stop holds the hand back, the goal waits, since a person without force feedback would press harder
  // and harder.
  Vec6 ahead = displacement(arm, {placed_at_.p + from_home, goal.q});
  Vec3 step = ahead.head<3>(), turned = ahead.tail<3>();
  shorten(step, settings_.leash_m);
  shorten(turned, settings_.leash_rad);
  ahead << step, turned;
  goal_.pose = displaced(arm, ahead);
  goal_.v = (goal_.pose.p - before.p) / dt;
  goal_.w = displacement(before, goal_.pose).tail<3>() / dt;
  arm_.guide(goal_);
  arm_.advance(dt);
}

void RateDevice::deliver(RateSample s) noexcept {
  if (!s.v.allFinite() || !s.w.allFinite()) return;
  s.time_ns = clock_.now_ns();
  s.valid = true;
  s.v = s.v.cwiseMax(-1).cwiseMin(1);
  s.w = s.w.cwiseMax(-1).cwiseMin(1);
  samples_.back() = s;
  samples_.publish();
}

void RateDevice::lost() noexcept {
  samples_.back() = RateSample{};
  samples_.publish();
}

}  // namespace insula
