// SPDX-License-Identifier: GPL-3.0-or-later
// A single device with its own servo thread, without engine and bus. Its forces pass the safety gate as always.
#pragma once
#include <atomic>
#include <memory>
#include <mutex>
#include <string>
#include <thread>

#include "haptic_server/device_tool/device_tool.h"
#include "haptic_server/devices/device_sample.h"
#include "haptic_server/devices/make_device.h"
#include "haptic_server/safety_gate.h"

namespace insula {

class DeviceSession {
 public:
  /// Starts the device. Throws InputError. `calibrated` false: with the maker's axes, without a stored calibration.
  explicit DeviceSession(const DeviceToolOptions& options, bool calibrated = true);
  ~DeviceSession();

  struct State {
    DeviceReading reading;
    DeviceSample raw;  ///< as the device measured it; not valid for a simulated arm
    Vec3 force = Vec3::Zero();
  };
  State state() const;
  /// Sets the force, scene axes. Zero fades it out as the gate does for a lost source.
  void push(const Vec3& force_N);
  /// Sleeps. False if a stop was requested.
  bool wait(double seconds) const;
  /// False after `seconds` without the device, or if a stop was requested.
  bool wait_for_device(double seconds) const;
  enum class Answer { yes, no_answer, lost, stopped };
  /// Waits for Enter, or for a new press of the device's first button.
  Answer ask(const std::string& text);

  const std::string& name() const { return name_; }  ///< name of its calibration
  const DeviceProfile& profile() const { return choice_.device->profile(); }
  std::string remark() const { return choice_.device->remark(); }
  bool streamed() const { return streamed_ != nullptr; }
  bool told_to_stop() const { return options_.stop != nullptr && options_.stop->load(); }

 private:
  void serve();

  DeviceToolOptions options_;
  std::string name_;
  DeviceChoice choice_;
  class StreamedDevice* streamed_ = nullptr;
  std::unique_ptr<SafetyGate> gate_;
  mutable std::mutex mutex_;
  State state_;
  Vec3 push_ = Vec3::Zero();
  std::atomic<bool> stopping_{false};
  std::thread thread_;
};

}  // namespace insula
