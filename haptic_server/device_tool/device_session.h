// SPDX-License-Identifier: GPL-3.0-or-later
// A device alone with a servo thread of its own, without engine and bus; its forces go through the safety gate as ever.
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
  /// Starts the device. Throws InputError. `calibrated` false: with the maker's axes, whatever is kept for it.
  explicit DeviceSession(const DeviceToolOptions& options, bool calibrated = true);
  ~DeviceSession();

  struct State {
    DeviceReading reading;
    DeviceSample raw;  ///< as the device measured it; not valid for a simulated arm
    Vec3 force = Vec3::Zero();
  };
  State state() const;
  /// Scene axes; zero ends the push as the gate ends a lost source.
  void push(const Vec3& force_N);
  /// Sleeps; false when it was told to stop.
  bool wait(double seconds) const;
  /// False after `seconds` without the device, or when told to stop.
  bool wait_for_device(double seconds) const;
  enum class Answer { yes, no_answer, lost, stopped };
  /// Enter, or the device's first button pressed anew.
  Answer ask(const std::string& text);

  const std::string& name() const { return name_; }  ///< under which it is calibrated
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
