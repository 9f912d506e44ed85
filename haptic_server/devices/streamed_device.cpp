// SPDX-License-Identifier: GPL-3.0-or-later
// Converts samples to poses of the scene, and forces to the device's axes.
#include "haptic_server/devices/streamed_device.h"

#include <algorithm>
#include <utility>

namespace insula {
namespace {

std::int64_t ns(double s) { return std::int64_t(s * 1e9); }

void shorten(Vec3& v, double limit) {
  const double length = v.norm();
  if (length > limit) v *= limit / length;
}

}  // namespace

DeviceSample StreamedDevice::raw() noexcept {
  samples_.update();
  DeviceSample s = samples_.front();
  // A sample may be slightly newer than the time read here.
  if (clock_.now_ns() - s.time_ns > ns(stale_after_s)) s.valid = false;
  return s;
}

DeviceReading StreamedDevice::read() noexcept {
  const DeviceSample s = raw();
  DeviceReading r;
  if (!s.valid) return r;
  const DeviceCalibration& c = calibration_;
  const Mat3 turn = person_to_scene_.toRotationMatrix() * c.axes;
  r.connected = true;
  r.pose.p = home_.p + c.scale * (turn * (s.pose.p - c.rest.p));
  const Quat turned(turn);
  r.pose.q = (turned * s.pose.q * c.rest.q.conjugate() * turned.conjugate() * home_.q).normalized();
  r.v = c.scale * (turn * s.v);
  r.w = turn * s.w;
  r.button1 = s.button1;
  r.button2 = s.button2;
  return r;
}

void StreamedDevice::write(const Vec3& force_N, const Vec3& torque_Nm) noexcept {
  const Mat3 turn = person_to_scene_.toRotationMatrix() * calibration_.axes;
  DeviceForce& f = forces_.back();
  f.time_ns = clock_.now_ns();
  f.force_N = turn.transpose() * force_N;
  f.torque_Nm = turn.transpose() * torque_Nm;
  forces_.publish();
}

void StreamedDevice::place(const Pose& pose, const Vec3& /*centre*/, const Vec3& /*extent*/) noexcept { home_ = pose; }

void StreamedDevice::deliver(DeviceSample s) noexcept {
  s.time_ns = clock_.now_ns();
  s.valid = true;
  if (!plausible(s)) {
    refused_.fetch_add(1, std::memory_order_relaxed);
    return;
  }
  s.pose.q.normalize();
  if (!s.has_w) {
    constexpr double smoothing_s = 0.02;
    const double dt = double(s.time_ns - last_.time_ns) * 1e-9;
    if (last_.valid && dt > 0 && dt < stale_after_s) {
      const Vec3 w = rotation_vector(s.pose.q * last_.pose.q.conjugate()) / dt;
      s.w = last_.w + dt / (smoothing_s + dt) * (w - last_.w);
    }
  }
  last_ = s;
  samples_.back() = s;
  samples_.publish();
}

void StreamedDevice::lost() noexcept {
  last_ = DeviceSample{};
  samples_.back() = last_;
  samples_.publish();
}

DeviceForce StreamedDevice::wanted() noexcept {
  forces_.update();
  DeviceForce f = forces_.front();
  const std::int64_t now = clock_.now_ns();
  const double age = double(now - f.time_ns) * 1e-9;
  const double left = std::clamp((stale_after_s - age) / (stale_after_s - silent_after_s), 0.0, 1.0);
  const double dt = std::min(double(now - wanted_ns_) * 1e-9, 0.005);
  wanted_ns_ = now;
  fade_ = std::min(left, fade_ + dt / stale_after_s);
  if (!f.force_N.allFinite() || !f.torque_Nm.allFinite()) f = DeviceForce{};
  shorten(f.force_N, limit_N_.load(std::memory_order_relaxed));
  shorten(f.torque_Nm, limit_Nm_.load(std::memory_order_relaxed));
  f.force_N *= fade_;
  f.torque_Nm *= fade_;
  return f;
}

void StreamedDevice::limit(double force_N, double torque_Nm) {
  limit_N_ = std::isfinite(force_N) ? std::clamp(force_N, 0.0, profile_.max_force_N) : 0;
  limit_Nm_ = std::isfinite(torque_Nm) ? std::clamp(torque_Nm, 0.0, profile_.max_torque_Nm) : 0;
}

}  // namespace insula
