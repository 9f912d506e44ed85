// SPDX-License-Identifier: GPL-3.0-or-later
// Opening, one exchange with the device, and recovery after a loss.
#include "haptic_server/devices/forcedimension.h"

#include <spdlog/spdlog.h>

#include <algorithm>
#include <chrono>
#include <cmath>

#include "core/base/input_error.h"

namespace insula {
namespace {

using namespace std::chrono_literals;
using Steady = std::chrono::steady_clock;

struct DataSheet {
  double force_N, torque_Nm, resolution_m;
  Vec3 workspace_m;
};

/// Continuous limits from the maker's data sheets, or low limits for an unknown model.
DataSheet data_sheet(int type) {
  switch (type) {
    case dhd::omega3:
    case dhd::omega6_left:
    case dhd::omega6_right:
    case dhd::omega7_left:
    case dhd::omega7_right: return {12, 0, 1e-5, {0.110, 0.160, 0.160}};
    case dhd::delta3: return {20, 0, 2e-5, {0.260, 0.400, 0.400}};
    case dhd::delta6: return {20, 0.15, 2e-5, {0.260, 0.400, 0.400}};
    case dhd::sigma7_left:
    case dhd::sigma7_right:
    case dhd::sigma6_left:
    case dhd::sigma6_right: return {20, 0.4, 1.5e-6, {0.130, 0.190, 0.190}};
    case dhd::falcon: return {8, 0, 6e-5, {0.1, 0.1, 0.1}};
    default: return {3.3, 0, 0, {0.1, 0.1, 0.1}};
  }
}

/// Largest force on a hand for any device. The forces of this surgery are far smaller.
constexpr double force_limit_N = 10;

}  // namespace

ForceDimensionDevice::ForceDimensionDevice(const std::string& which, DeviceCalibration calibration)
    : StreamedDevice(std::move(calibration)), title_("forcedimension" + (which.empty() ? std::string() : ":" + which)) {
  profile_.name = "forcedimension";
  if (which.empty()) return;
  const bool position = which.front() == '#';
  const std::string digits = which.substr(position ? 1 : 0);
  if (digits.empty() || digits.size() > 5 || digits.find_first_not_of("0123456789") != std::string::npos)
    throw InputError(title_ + ": name it by its serial number or by #0, #1... in the library's order");
  (position ? index_ : serial_) = std::stoi(digits);
}

ForceDimensionDevice::~ForceDimensionDevice() { stop(); }

DeviceCalibration ForceDimensionDevice::default_calibration() {
  DeviceCalibration c;
  c.axes << 0, 1, 0, -1, 0, 0, 0, 0, 1;
  return c;
}

void ForceDimensionDevice::start() {
  if (thread_.joinable()) return;
  api_ = dhd::Api::shared();
  if (!api_->library.loaded()) throw InputError("forcedimension: " + api_->library.error() + "; " + dhd::how_to_get());
  if (serial_ >= 0 && api_->open_serial == nullptr)
    throw InputError(title_ + ": this release of libdhd cannot open by serial number; use #0, #1...");
  stopping_ = false;
  if (!open()) spdlog::warn("{}", remark());
  profile_fixed_ = true;
  thread_ = std::thread([this] { serve(); });
}

void ForceDimensionDevice::stop() {
  stopping_ = true;
  if (thread_.joinable()) thread_.join();
}

bool ForceDimensionDevice::open() {
  std::lock_guard lock(api_->open_mutex);
  int id = -1;
  if (serial_ >= 0) {
    id = api_->open_serial(serial_);
  } else if (index_ >= 0) {
    id = api_->open.contains(index_) ? -1 : api_->open_id(char(index_));
  } else {
    const int there = std::clamp(api_->device_count(), 0, 16);
    for (int i = 0; i < there && id < 0; ++i)
      if (!api_->open.contains(i)) id = api_->open_id(char(i));
  }
  if (id < 0 || api_->open.contains(id)) {
    const char* why = api_->last_error();
    set_remark(title_ + " is not there (" + (why != nullptr ? why : "no reason given") +
               "); is it switched on, plugged in, and free?");
    return false;
  }
  api_->open.insert(id);
  id_ = id;
  const char nr = char(id);
  const DataSheet sheet = data_sheet(api_->system_type(nr));
  torques_ = sheet.torque_Nm > 0 && (api_->has_active_wrist == nullptr || api_->has_active_wrist(nr));
  const bool weightless = !dhd::failed(api_->gravity_compensation(dhd::on, nr));
  if (!profile_fixed_) {
    profile_.gravity_compensated = weightless;
    profile_.max_force_N = std::min(sheet.force_N, force_limit_N);
    profile_.max_slew_N_s = 20 * profile_.max_force_N;
    profile_.max_torque_Nm = torques_ ? sheet.torque_Nm : 0;
    profile_.max_slew_Nm_s = 20 * profile_.max_torque_Nm;
    profile_.resolution_m = sheet.resolution_m;
    profile_.workspace_m = (calibration().axes * sheet.workspace_m).cwiseAbs();
    double mass = 0;
    if (api_->effector_mass != nullptr && !dhd::failed(api_->effector_mass(&mass, nr)) && mass > 0 && mass < 5)
      profile_.apparent_mass_kg = mass;
    if (!weightless) profile_.weight_N = 9.81 * profile_.apparent_mass_kg;
  }
  limit(sheet.force_N, torques_ ? sheet.torque_Nm : 0);
  api_->set_force(0, 0, 0, 0, 0, 0, 0, nr);
  api_->enable_force(dhd::on, nr);
  set_remark("");
  return true;
}

void ForceDimensionDevice::close() {
  if (id_ < 0) return;
  std::lock_guard lock(api_->open_mutex);
  api_->set_force(0, 0, 0, 0, 0, 0, 0, char(id_));
  api_->close(char(id_));
  api_->open.erase(id_);
  id_ = -1;
  lost();
}

bool ForceDimensionDevice::tick() {
  const char nr = char(id_);
  DeviceSample s;
  double frame[3][3];
  double x = 0, y = 0, z = 0;
  if (dhd::failed(api_->pose(&x, &y, &z, frame, nr))) return false;
  s.pose.p = Vec3(x, y, z);
  Mat3 turn;
  for (int r = 0; r < 3; ++r)
    for (int c = 0; c < 3; ++c) turn(r, c) = frame[r][c];
  s.pose.q = Quat(turn);
  if (dhd::failed(api_->linear_velocity(&x, &y, &z, nr))) return false;
  s.v = Vec3(x, y, z);
  if (api_->angular_velocity != nullptr && !dhd::failed(api_->angular_velocity(&x, &y, &z, nr))) {
    s.w = Vec3(x, y, z);
    s.has_w = true;
  }
  s.button1 = api_->button(0, nr) == dhd::on;
  s.button2 = api_->button(1, nr) == dhd::on;
  deliver(s);
  const DeviceForce f = wanted();
  const Vec3 t = torques_ ? f.torque_Nm : Vec3(Vec3::Zero());
  return !dhd::failed(api_->set_force(f.force_N.x(), f.force_N.y(), f.force_N.z(), t.x(), t.y(), t.z(), 0, nr));
}

void ForceDimensionDevice::serve() {
  auto next = Steady::now();
  while (!stopping_) {
    if (id_ < 0) {
      for (auto waited = 0ms; waited < reopen_after && !stopping_; waited += 20ms) std::this_thread::sleep_for(20ms);
      if (!stopping_ && open()) spdlog::info("{} is there", title_);
      next = Steady::now();
      continue;
    }
    if (!tick()) {
      const char* why = api_->last_error();
      const std::string text = title_ + " was lost (" + (why != nullptr ? why : "no reason given") +
                               "); it comes back by itself when it is plugged in again";
      close();
      set_remark(text);
      spdlog::warn("{}", text);
      continue;
    }
    // A call that waited for the bus has already used its millisecond.
    next = std::max(next + 1ms, Steady::now() - 1ms);
    std::this_thread::sleep_until(next);
  }
  close();
}

}  // namespace insula
