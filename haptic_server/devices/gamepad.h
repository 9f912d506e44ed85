// SPDX-License-Identifier: GPL-3.0-or-later
// Gamepads through SDL2.
#pragma once
#include <atomic>
#include <cstdint>
#include <memory>
#include <mutex>
#include <set>
#include <string>
#include <thread>

#include "haptic_server/devices/rate_device.h"
#include "haptic_server/devices/shared_library.h"

namespace insula {

namespace sdl {

enum Axis { left_x, left_y, right_x, right_y, trigger_left, trigger_right };  // SDL_CONTROLLER_AXIS_...
enum Button { a = 0, b = 1, shoulder_left = 9, shoulder_right = 10 };         // SDL_CONTROLLER_BUTTON_...
struct Controller;                                                            // SDL_GameController
struct Joystick;                                                              // SDL_Joystick

struct Api {
  Api();
  ~Api();
  SharedLibrary library;
  int (*init)(std::uint32_t);
  void (*quit)(std::uint32_t);
  int (*set_hint)(const char*, const char*);
  void (*flush_events)(std::uint32_t, std::uint32_t);
  int (*count)();
  int (*is_controller)(int);
  const char* (*name_of)(int);
  std::int32_t (*instance_of)(int);
  Controller* (*open)(int);
  void (*close)(Controller*);
  int (*attached)(Controller*);
  Joystick* (*joystick)(Controller*);
  std::int32_t (*instance)(Joystick*);
  std::int16_t (*axis)(Controller*, int);
  std::uint8_t (*button)(Controller*, int);
  const char* (*serial)(Controller*);  // newer releases only
  void (*update)();
  bool ready = false;

  std::mutex mutex;              ///< around every call: SDL keeps one list of all gamepads
  std::set<std::int32_t> taken;  ///< instances in use by a hand

  static std::shared_ptr<Api> shared();
};

const char* how_to_get();

}  // namespace sdl

/// Left stick: right and away. Triggers: down and up. Right stick: rotation about up and about right. Shoulders: roll.
/// A, B: the buttons.
class GamepadDevice final : public RateDevice {
 public:
  /// `which`: a name or serial number, "#0", "#1"..., or empty: the first one that is not in use by the other hand.
  GamepadDevice(std::string which, int hand, const DeviceCalibration& calibration = {});
  ~GamepadDevice() override;
  /// Throws InputError when SDL2 is missing. Waits for a missing gamepad in the background.
  void start() override;
  void stop() override;

 private:
  void serve();
  bool open();
  void close();

  std::string which_;
  std::shared_ptr<sdl::Api> api_;
  std::thread thread_;
  std::atomic<bool> stopping_{false};
  sdl::Controller* pad_ = nullptr;
  std::int32_t instance_ = -1;
};

}  // namespace insula
