// SPDX-License-Identifier: GPL-3.0-or-later
// Phantom Omni, Touch and related arms through OpenHaptics.
#pragma once
#include <array>
#include <atomic>
#include <memory>
#include <string>
#include <thread>

#include "haptic_server/devices/openhaptics_api.h"
#include "haptic_server/devices/streamed_device.h"

namespace insula {

/// The library's scheduler calls back a thousand times a second and exchanges samples and forces. The driver's own
/// thread opens the device, and opens it again after a loss, which may take long. OpenHaptics frame: x right, y up, z
/// to the person; millimetres.
class OpenHapticsDevice final : public StreamedDevice {
 public:
  /// `name`: given to the arm in the maker's setup program; empty: the default device.
  explicit OpenHapticsDevice(std::string name, DeviceCalibration calibration = default_calibration());
  ~OpenHapticsDevice() override;
  /// Throws InputError when the library is missing. Waits for a missing device in the background.
  void start() override;
  void stop() override;

  static DeviceCalibration default_calibration();

 private:
  static hd::CallbackCode call_back(void* self);
  hd::CallbackCode frame();
  void look_after();
  bool open();
  void close();
  void take_over_facts();
  void first_frame();
  bool device_lost();
  std::string title() const { return name_.empty() ? "touch" : "touch:\"" + name_ + "\""; }

  std::string name_;
  std::shared_ptr<hd::Api> api_;
  std::thread keeper_;
  std::atomic<bool> stopping_{false};
  bool profile_fixed_ = false;
  std::atomic<bool> leave_{false};    ///< requests the end of the callback
  std::atomic<bool> running_{false};  ///< the callback is scheduled and has not ended
  std::atomic<unsigned int> error_{0};
  hd::Handle handle_ = hd::invalid_handle;
  hd::SchedulerHandle scheduled_ = 0;

  /// Properties that the device reports in its first frame, in which it is certainly the current device.
  struct Facts {
    double max_force_N = 0;
    std::array<double, 6> box_mm{};
    int calibration_style = 0;
    std::array<char, 64> model{};
  };
  Facts facts_;
  std::atomic<bool> facts_known_{false};
  // Used only by the callback.
  bool calibrated_ = false;
  int frames_ = 0;
};

}  // namespace insula
