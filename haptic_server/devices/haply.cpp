// SPDX-License-Identifier: GPL-3.0-or-later
// Sessions with the Inverse Service.
#include "haptic_server/devices/haply.h"

#include <spdlog/spdlog.h>

#include <chrono>
#include <cstdlib>

#include "haptic_server/devices/web_socket_client.h"

namespace insula {
namespace {

using namespace std::chrono_literals;
using Steady = std::chrono::steady_clock;

constexpr auto patience = 1000ms;  // of one exchange; a lost device is reported before that

}  // namespace

HaplyDevice::HaplyDevice(const std::string& which, int hand, DeviceCalibration calibration)
    : StreamedDevice(std::move(calibration)),
      hand_(hand),
      title_("haply" + (which.empty() ? std::string() : ":" + which)) {
  const std::size_t plus = which.find('+');
  arm_id_ = which.substr(0, plus);
  if (plus != std::string::npos) grip_id_ = which.substr(plus + 1);
  profile_.name = "haply";
  // Insula's own limit, well below the arm's. The service has further limits.
  profile_.max_force_N = 4;
  profile_.max_slew_N_s = 80;
  profile_.resolution_m = 5e-5;
  profile_.workspace_m = Vec3(0.2, 0.15, 0.2);
  profile_.gravity_compensated = true;
  limit(profile_.max_force_N, 0);
}

HaplyDevice::~HaplyDevice() { stop(); }

DeviceCalibration HaplyDevice::default_calibration() {
  DeviceCalibration c;
  c.rest.p = Vec3(0, -0.12, 0.15);
  return c;
}

std::string HaplyDevice::url() {
  const char* chosen = std::getenv("INSULA_HAPLY_URL");
  return chosen != nullptr && *chosen != '\0' ? chosen : "ws://localhost:10001";
}

void HaplyDevice::start() {
  if (thread_.joinable()) return;
  stopping_ = tried_ = false;
  thread_ = std::thread([this] { serve(); });
  for (int i = 0; i < 1500 && !tried_; ++i) std::this_thread::sleep_for(1ms);
}

void HaplyDevice::stop() {
  stopping_ = true;
  if (thread_.joinable()) thread_.join();
}

void HaplyDevice::say(const std::string& text) {
  if (text == remark()) return;
  set_remark(text);
  if (!text.empty()) spdlog::warn("{}", text);
}

void HaplyDevice::serve() {
  while (!stopping_) {
    WebSocketClient service;
    if (service.connect(url(), patience)) {
      session(service);
      if (!stopping_ && !service.connected())
        say(title_ + ": the Haply service is gone (" + service.error() + "); waiting for it");
    } else {
      say(title_ + ": no Haply service at " + url() + " (" + service.error() + "); " + how_to_get_haply());
    }
    lost();
    tried_ = true;
    for (auto waited = 0ms; waited < reopen_after && !stopping_; waited += 20ms) std::this_thread::sleep_for(20ms);
  }
}

const HaplyArm* HaplyDevice::choose_arm(const HaplyState& state) const {
  if (state.arms.empty()) return nullptr;
  if (!arm_id_.empty()) {
    for (const HaplyArm& arm : state.arms)
      if (arm.id == arm_id_) return &arm;
    return nullptr;
  }
  for (const HaplyArm& arm : state.arms)
    if (arm.handedness == (hand_ == 0 ? "left" : "right")) return &arm;
  return hand_ == 0 ? &state.arms.front() : &state.arms.back();
}

const HaplyGrip* HaplyDevice::choose_grip(const HaplyState& state, const HaplyArm& arm) const {
  if (!grip_id_.empty()) {
    for (const HaplyGrip& grip : state.grips)
      if (grip.id == grip_id_) return &grip;
    return nullptr;
  }
  // With as many grips as arms, they correspond in order.
  for (std::size_t i = 0; i < state.arms.size() && i < state.grips.size(); ++i)
    if (state.arms[i].id == arm.id) return &state.grips[i];
  return nullptr;
}

void HaplyDevice::deliver(const HaplyArm& arm, const HaplyGrip* grip) {
  DeviceSample s;
  s.pose.p = *arm.p_m;
  // Without a grip the tool keeps the orientation of the rest pose.
  s.pose.q = grip != nullptr && grip->q ? *grip->q : calibration().rest.q;
  s.v = arm.v_m_s.value_or(Vec3::Zero());
  s.button1 = grip != nullptr && grip->button1;
  s.button2 = grip != nullptr && grip->button2;
  StreamedDevice::deliver(s);
}

void HaplyDevice::session(WebSocketClient& service) {
  std::string id;  // of the arm, from the first message, the only one with the handedness
  bool named_vector = false, introduce = true;
  HaplyState state;
  std::string_view text;
  std::string why;
  auto next = Steady::now();
  while (!stopping_ && service.receive(text, patience)) {
    if (!parse_haply(text, state, why)) {
      messages_refused_.fetch_add(1, std::memory_order_relaxed);
    } else {
      named_vector = named_vector || state.named_vector;
      const HaplyArm* arm = nullptr;
      if (id.empty()) {
        arm = choose_arm(state);
        if (arm != nullptr) id = arm->id;
      } else {
        for (const HaplyArm& a : state.arms)
          if (a.id == id) arm = &a;
      }
      tried_ = true;
      if (arm == nullptr || !arm->ready) {
        lost();
        say(title_ + (arm == nullptr ? ": the Haply service has no such arm; is it plugged in and switched on?"
                                     : ": the arm is not ready; follow Haply Hub"));
        // Only a new connection gets a new inventory.
        if (arm == nullptr) return;
      } else if (arm->p_m) {
        say("");
        deliver(*arm, choose_grip(state, *arm));
      }
    }
    next = std::max(next + 1ms, Steady::now());
    std::this_thread::sleep_until(next);
    const Vec3 force = stopping_ || id.empty() ? Vec3(Vec3::Zero()) : wanted().force_N;
    if (!service.send(haply_force(id, force, named_vector, introduce), patience)) return;
    introduce = false;
  }
  if (stopping_ && service.connected()) service.send(haply_force(id, Vec3::Zero(), named_vector, false), patience);
}

const char* how_to_get_haply() {
  return "install and start Haply Hub or the Haply Inverse Service (develop.haply.co); a service elsewhere: "
         "INSULA_HAPLY_URL=ws://host:port";
}

}  // namespace insula
