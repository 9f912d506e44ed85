// SPDX-License-Identifier: GPL-3.0-or-later
// The servo of a single device.
#include "haptic_server/device_tool/device_session.h"

#include <poll.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <ostream>

#include "haptic_server/devices/device_kinds.h"
#include "haptic_server/devices/streamed_device.h"

namespace insula {
namespace {

using namespace std::chrono_literals;
using Steady = std::chrono::steady_clock;

/// The force is unexpected, so it changes more slowly than in an exercise.
constexpr double gentle_ramp_s = 1, gentle_slew_N_s = 5;

}  // namespace

DeviceSession::DeviceSession(const DeviceToolOptions& options, bool calibrated) : options_(options) {
  const DeviceWish wish = choose_device(parse_device_wishes(options.device));
  name_ = wish.calibration_name(options.hand);
  const DeviceKind& kind = *find_device_kind(wish.kind);
  choice_ = calibrated ? make_device(wish.text(), options.hand) : kind.make(wish.which, options.hand, kind.calibration);
  choice_.device->start();
  streamed_ = dynamic_cast<StreamedDevice*>(choice_.device.get());
  DeviceProfile gentle = profile();
  gentle.ramp_in_s = std::max(gentle.ramp_in_s, gentle_ramp_s);
  gentle.max_slew_N_s = std::min(gentle.max_slew_N_s, gentle_slew_N_s);
  gate_ = std::make_unique<SafetyGate>(gentle);
  if (streamed_ == nullptr) choice_.device->place(Pose(), Vec3::Zero(), profile().workspace_m);
  thread_ = std::thread([this] { serve(); });
}

DeviceSession::~DeviceSession() {
  push(Vec3::Zero());
  for (int i = 0; i < 1500 && !state().force.isZero(0); ++i) std::this_thread::sleep_for(1ms);
  stopping_ = true;
  thread_.join();
  choice_.device->write(Vec3::Zero(), Vec3::Zero());
  choice_.device->stop();
}

void DeviceSession::serve() {
  Device& device = *choice_.device;
  auto next = Steady::now(), last = next;
  while (!stopping_) {
    const auto now = Steady::now();
    const double dt = std::chrono::duration<double>(now - last).count();
    last = now;
    if (device.simulated()) device.advance(std::min(dt, 0.02));
    State s;
    if (streamed_ != nullptr) s.raw = streamed_->raw();
    s.reading = device.read();
    {
      std::lock_guard lock(mutex_);
      gate_->apply(dt, s.reading.connected && !push_.isZero(0), push_, Vec3::Zero());
      s.force = gate_->force();
      state_ = s;
    }
    device.write(s.force, Vec3::Zero());
    next = std::max(next + 1ms, now);
    std::this_thread::sleep_until(next);
  }
}

DeviceSession::State DeviceSession::state() const {
  std::lock_guard lock(mutex_);
  return state_;
}

void DeviceSession::push(const Vec3& force_N) {
  std::lock_guard lock(mutex_);
  push_ = force_N;
}

bool DeviceSession::wait(double seconds) const {
  const auto end = Steady::now() + std::chrono::duration<double>(seconds);
  while (Steady::now() < end && !told_to_stop()) std::this_thread::sleep_for(5ms);
  return !told_to_stop();
}

bool DeviceSession::wait_for_device(double seconds) const {
  const auto end = Steady::now() + std::chrono::duration<double>(seconds);
  while (!state().reading.connected && Steady::now() < end && wait(0.01)) {
  }
  return state().reading.connected;
}

DeviceSession::Answer DeviceSession::ask(const std::string& text) {
  *options_.out << text << std::endl;
  const auto end = Steady::now() + std::chrono::duration<double>(options_.patience_s);
  bool was_pressed = true;  // a button that is already held is not an answer
  auto gone_since = Steady::now();
  while (Steady::now() < end) {
    if (told_to_stop()) return Answer::stopped;
    const State s = state();
    if (s.reading.connected) gone_since = Steady::now();
    if (Steady::now() - gone_since > 2s) return Answer::lost;
    if (s.reading.connected && s.reading.button1 && !was_pressed) return Answer::yes;
    was_pressed = s.reading.connected ? s.reading.button1 : true;
    pollfd p{options_.input, POLLIN, 0};
    if (options_.input < 0 || ::poll(&p, 1, 5) <= 0) {
      std::this_thread::sleep_for(2ms);
      continue;
    }
    char c = 0;
    if (::read(options_.input, &c, 1) != 1) {
      options_.input = -1;  // closed: only the button remains
      continue;
    }
    if (c == '\n') return Answer::yes;
  }
  return Answer::no_answer;
}

}  // namespace insula
