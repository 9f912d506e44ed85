// SPDX-License-Identifier: GPL-3.0-or-later
// 3Dconnexion's SpaceMouse and related devices through libspnav and the daemon spacenavd.
#pragma once
#include <atomic>
#include <memory>
#include <string>
#include <thread>

#include "haptic_server/devices/rate_device.h"
#include "haptic_server/devices/shared_library.h"

namespace insula {

namespace spnav {

enum EventType { motion = 1, button = 2, device = 3 };  // SPNAV_EVENT_MOTION, _BUTTON, _DEV
inline constexpr int device_removed = 1;                // SPNAV_DEV_RM

/// spnav_event, a union of int structures; large enough for every kind of event of libspnav 1.x.
union Event {
  int type;
  struct {
    int type, x, y, z, rx, ry, rz;
    unsigned int period;
    int* data;
  } motion;
  struct {
    int type, press, number;
  } button;
  struct {
    int type, operation, id, model, usb[2];
  } device;
  unsigned char room[128];
};

struct Api {
  Api();
  SharedLibrary library;
  int (*open)();
  int (*close)();
  int (*descriptor)();
  int (*poll_event)(Event*);
  int (*event_mask)(unsigned int);  // newer releases only
  int (*device_name)(char*, int);   // newer releases only
  std::atomic<bool> in_use{false};  ///< one connection for each process, which all devices share

  static std::shared_ptr<Api> shared();
};

const char* how_to_get();

}  // namespace spnav

/// Full deflection of a SpaceMouse is about 350 counts.
class SpaceMouseDevice final : public RateDevice {
 public:
  SpaceMouseDevice(int hand, const DeviceCalibration& calibration = {});
  ~SpaceMouseDevice() override;
  /// Throws InputError when the library is missing or the other hand already uses the SpaceMouse, since the daemon
  /// merges all connected ones. Waits for a missing daemon or device in the background.
  void start() override;
  void stop() override;

 private:
  void serve();
  bool listen();
  bool take(const spnav::Event& event);

  std::shared_ptr<spnav::Api> api_;
  std::thread thread_;
  std::atomic<bool> stopping_{false};
  bool mine_ = false, open_ = false;
  bool device_there_ = true;
  RateSample sample_;
  std::int64_t moved_ns_ = 0;
};

}  // namespace insula
