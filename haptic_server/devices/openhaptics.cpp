// SPDX-License-Identifier: GPL-3.0-or-later
// Opening, one scheduler frame, and recovery after a loss.
#include "haptic_server/devices/openhaptics.h"

#include <spdlog/spdlog.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <cstring>

#include "core/base/input_error.h"
#include "haptic_server/devices/known_friction.h"

namespace insula {
namespace {

using namespace std::chrono_literals;

constexpr int calibration_check_frames = 200;
/// Largest force on a hand for any device. The forces of this surgery are far smaller.
constexpr double force_limit_N = 10;

/// A model's friction and mass from its maker's data sheet (Omni and Touch are one design).
void add_data_sheet(const std::string& model, DeviceProfile& profile) {
  profile.resolution_m = 55e-6;
  profile.workspace_m = Vec3(0.160, 0.120, 0.070);
  profile.friction_N = touch_friction.friction_N;
  profile.apparent_mass_kg = 0.045;
  if (model.find("Premium") == std::string::npos && model.find("Touch X") == std::string::npos &&
      model.find("Desktop") == std::string::npos)
    return;
  profile.resolution_m = 23e-6;
  profile.friction_N = touch_x_friction.friction_N;
}

}  // namespace

OpenHapticsDevice::OpenHapticsDevice(std::string name, DeviceCalibration calibration)
    : StreamedDevice(std::move(calibration)), name_(std::move(name)) {
  profile_.name = "touch";
  profile_.max_force_N = 3.3;
  profile_.max_slew_N_s = 66;
  add_data_sheet("", profile_);
}

OpenHapticsDevice::~OpenHapticsDevice() { stop(); }

DeviceCalibration OpenHapticsDevice::default_calibration() {
  DeviceCalibration c;
  c.axes << 1, 0, 0, 0, 0, -1, 0, 1, 0;
  return c;
}

void OpenHapticsDevice::start() {
  if (keeper_.joinable()) return;
  api_ = hd::Api::shared();
  if (!api_->library.loaded()) throw InputError("touch: " + api_->library.error() + "; " + hd::how_to_get());
  stopping_ = false;
  // The first attempt is made here, so that the profile is complete when start returns.
  if (!open()) spdlog::warn("{}", remark());
  profile_fixed_ = true;
  keeper_ = std::thread([this] { look_after(); });
}

void OpenHapticsDevice::stop() {
  stopping_ = true;
  if (keeper_.joinable()) keeper_.join();
  close();
}

bool OpenHapticsDevice::open() {
  while (api_->get_error().code != hd::success) {
  }
  const hd::Handle handle = api_->init_device(name_.empty() ? nullptr : name_.c_str());
  const hd::ErrorInfo error = api_->get_error();
  if (error.code != hd::success || handle == hd::invalid_handle) {
    const char* why = api_->error_string(error.code);
    set_remark(title() + " is not there (" + (why != nullptr ? why : "no reason given") +
               "); is it switched on, and known to the driver's setup program by this name?");
    return false;
  }
  handle_ = handle;
  limit(0, 0);
  facts_known_ = false;
  calibrated_ = false;
  frames_ = 0;
  error_ = 0;
  leave_ = false;
  running_ = true;
  set_remark("");
  scheduled_ = api_->schedule(&call_back, this, hd::default_priority);
  api_->use_scheduler();
  for (int i = 0; i < 1000 && running_ && !facts_known_; ++i) std::this_thread::sleep_for(1ms);
  if (facts_known_) take_over_facts();
  return true;
}

void OpenHapticsDevice::take_over_facts() {
  const double force =
      std::isfinite(facts_.max_force_N) && facts_.max_force_N > 0 ? facts_.max_force_N : profile_.max_force_N;
  if (!profile_fixed_) {
    add_data_sheet(facts_.model.data(), profile_);
    profile_.max_force_N = std::min(force, force_limit_N);
    profile_.max_slew_N_s = 20 * profile_.max_force_N;
    const auto& box = facts_.box_mm;
    const Vec3 edges = 1e-3 * Vec3(box[3] - box[0], box[4] - box[1], box[5] - box[2]);
    if (edges.allFinite() && edges.minCoeff() > 0 && edges.maxCoeff() < 2)
      profile_.workspace_m = (calibration().axes * edges).cwiseAbs();
  }
  limit(force, 0);
}

void OpenHapticsDevice::close() {
  if (handle_ == hd::invalid_handle) return;
  leave_ = true;
  for (int i = 0; i < 200 && running_; ++i) std::this_thread::sleep_for(1ms);
  // If the scheduler no longer calls, the callback is removed, so that it cannot run again while this object is
  // destroyed.
  if (running_) api_->unschedule(scheduled_);
  running_ = false;
  api_->leave_scheduler();
  api_->disable_device(handle_);
  handle_ = hd::invalid_handle;
  lost();
}

void OpenHapticsDevice::look_after() {
  while (!stopping_) {
    if (handle_ != hd::invalid_handle && !running_) {
      const char* why = api_->error_string(error_);
      close();
      set_remark(title() + " was lost (" + (why != nullptr ? why : "no reason given") +
                 "); it comes back by itself when it is plugged in again");
      spdlog::warn("{}", remark());
    }
    if (handle_ == hd::invalid_handle) {
      for (auto waited = 0ms; waited < reopen_after && !stopping_; waited += 20ms) std::this_thread::sleep_for(20ms);
      if (!stopping_ && open()) spdlog::info("{} is there", title());
      continue;
    }
    std::this_thread::sleep_for(20ms);
  }
}

hd::CallbackCode OpenHapticsDevice::call_back(void* self) { return static_cast<OpenHapticsDevice*>(self)->frame(); }

bool OpenHapticsDevice::device_lost() {
  // Errors of forces (warm motors, too high speed) are the device's own protection. The device continues by itself.
  bool gone = false;
  for (int i = 0; i < 16; ++i) {
    const hd::ErrorInfo e = api_->get_error();
    if (e.code == hd::success) break;
    if (e.code < hd::device_fault || e.code > hd::last_device_error) continue;
    if (e.device != handle_ && e.device != hd::invalid_handle) continue;
    error_ = e.code;
    gone = true;
  }
  return gone;
}

void OpenHapticsDevice::first_frame() {
  api_->enable(hd::force_output);
  api_->enable(hd::max_force_clamping);
  facts_ = Facts{};
  api_->get_doubles(hd::nominal_max_force, &facts_.max_force_N);
  api_->get_doubles(hd::usable_workspace, facts_.box_mm.data());
  api_->get_integers(hd::calibration_style, &facts_.calibration_style);
  const char* model = api_->get_string(hd::device_model_type);
  if (model != nullptr) std::strncpy(facts_.model.data(), model, facts_.model.size() - 1);
}

hd::CallbackCode OpenHapticsDevice::frame() {
  const bool leave = leave_;
  api_->begin_frame(handle_);
  if (frames_ == 0) first_frame();
  DeviceSample s;
  std::array<double, 16> m{};
  std::array<double, 3> v{};
  int buttons = 0;
  api_->get_doubles(hd::current_transform, m.data());
  api_->get_doubles(hd::current_velocity, v.data());
  api_->get_integers(hd::current_buttons, &buttons);
  const DeviceForce f = wanted();
  // Uncalibrated encoders would give forces at a wrong position.
  const Vec3 force = leave || !calibrated_ ? Vec3(Vec3::Zero()) : f.force_N;
  api_->set_doubles(hd::current_force, force.data());
  api_->end_frame(handle_);
  if (device_lost()) {
    lost();
    running_ = false;
    return hd::callback_done;
  }
  if (frames_++ % calibration_check_frames == 0) {
    const hd::Enum state = api_->check_calibration();
    if (state == hd::calibration_needs_update) api_->update_calibration(hd::Enum(facts_.calibration_style));
    calibrated_ = state == hd::calibration_ok || state == hd::calibration_needs_update;
    facts_known_ = true;
  }
  if (leave) {
    running_ = false;
    return hd::callback_done;
  }
  if (!calibrated_) {
    lost();
    return hd::callback_continue;
  }
  Mat3 turn;
  for (Eigen::Index c = 0; c < 3; ++c)
    for (Eigen::Index r = 0; r < 3; ++r) turn(r, c) = m[std::size_t(4 * c + r)];
  s.pose.p = 1e-3 * Vec3(m[12], m[13], m[14]);
  s.pose.q = Quat(turn);
  s.v = 1e-3 * Vec3(v[0], v[1], v[2]);
  s.button1 = (buttons & hd::button_1) != 0;
  s.button2 = (buttons & hd::button_2) != 0;
  deliver(s);
  return hd::callback_continue;
}

}  // namespace insula
