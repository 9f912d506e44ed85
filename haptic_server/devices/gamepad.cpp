// SPDX-License-Identifier: GPL-3.0-or-later
// Reading gamepads.
#include "haptic_server/devices/gamepad.h"

#include <spdlog/spdlog.h>

#include <chrono>
#include <cmath>

#include "core/base/input_error.h"

namespace insula {
namespace {

using namespace std::chrono_literals;

constexpr auto period = 4ms;
constexpr std::uint32_t init_game_controller = 0x2000;  // SDL_INIT_GAMECONTROLLER
constexpr double dead_zone = 0.12;

/// Maps a stick's counts to -1..1, with a dead zone and a fine resolution in the middle.
double deflection(std::int16_t counts) {
  const double x = std::max(-1.0, counts / 32767.0), beyond = std::abs(x) - dead_zone;
  if (beyond <= 0) return 0;
  const double u = beyond / (1 - dead_zone);
  return std::copysign(u * u, x);
}

}  // namespace

sdl::Api::Api() : library("INSULA_LIBSDL2", {"libSDL2-2.0.so.0", "libSDL2.so"}) {
  library.find(init, "SDL_Init");
  library.find(quit, "SDL_QuitSubSystem");
  library.find(set_hint, "SDL_SetHint");
  library.find(flush_events, "SDL_FlushEvents");
  library.find(count, "SDL_NumJoysticks");
  library.find(is_controller, "SDL_IsGameController");
  library.find(name_of, "SDL_GameControllerNameForIndex");
  library.find(instance_of, "SDL_JoystickGetDeviceInstanceID");
  library.find(open, "SDL_GameControllerOpen");
  library.find(close, "SDL_GameControllerClose");
  library.find(attached, "SDL_GameControllerGetAttached");
  library.find(joystick, "SDL_GameControllerGetJoystick");
  library.find(instance, "SDL_JoystickInstanceID");
  library.find(axis, "SDL_GameControllerGetAxis");
  library.find(button, "SDL_GameControllerGetButton");
  library.find(serial, "SDL_GameControllerGetSerial", false);
  library.find(update, "SDL_GameControllerUpdate");
  if (!library.loaded()) return;
  // Without these, SDL would handle Ctrl-C itself, and read only while a window of its own has the focus.
  set_hint("SDL_NO_SIGNAL_HANDLERS", "1");
  set_hint("SDL_JOYSTICK_ALLOW_BACKGROUND_EVENTS", "1");
  ready = init(init_game_controller) == 0;
}

sdl::Api::~Api() {
  if (ready) quit(init_game_controller);
}

std::shared_ptr<sdl::Api> sdl::Api::shared() { return shared_while_used<Api>(); }

const char* sdl::how_to_get() {
  return "sudo apt install libsdl2-2.0-0; the user must be allowed to read /dev/input/event*";
}

GamepadDevice::GamepadDevice(std::string which, int hand, const DeviceCalibration& calibration)
    : RateDevice("gamepad", hand, calibration), which_(std::move(which)) {}

GamepadDevice::~GamepadDevice() { stop(); }

void GamepadDevice::start() {
  if (thread_.joinable()) return;
  api_ = sdl::Api::shared();
  if (!api_->library.loaded() || !api_->ready)
    throw InputError(
        "gamepad: " + (api_->library.loaded() ? std::string("SDL2 does not start") : api_->library.error()) + "; " +
        sdl::how_to_get());
  stopping_ = false;
  thread_ = std::thread([this] { serve(); });
}

void GamepadDevice::stop() {
  stopping_ = true;
  if (thread_.joinable()) thread_.join();
}

bool GamepadDevice::open() {
  std::lock_guard lock(api_->mutex);
  api_->update();
  const bool numbered = which_.starts_with('#');
  int number = -1;  // among the gamepads, so that "#1" is the second one for any other connected devices
  for (int i = 0; i < api_->count(); ++i) {
    if (!api_->is_controller(i)) continue;
    ++number;
    const std::int32_t id = api_->instance_of(i);
    if (api_->taken.contains(id) || (numbered && which_ != "#" + std::to_string(number))) continue;
    const char* name = api_->name_of(i);
    bool fits = which_.empty() || numbered || (name != nullptr && which_ == name);
    sdl::Controller* pad = api_->open(i);
    if (pad == nullptr) continue;
    if (!fits && api_->serial != nullptr) {
      const char* serial = api_->serial(pad);
      fits = serial != nullptr && which_ == serial;
    }
    if (!fits) {
      api_->close(pad);
      continue;
    }
    pad_ = pad;
    instance_ = id;
    api_->taken.insert(id);
    return true;
  }
  return false;
}

void GamepadDevice::close() {
  if (pad_ == nullptr) return;
  std::lock_guard lock(api_->mutex);
  api_->close(pad_);
  api_->taken.erase(instance_);
  pad_ = nullptr;
}

void GamepadDevice::serve() {
  while (!stopping_) {
    if (pad_ == nullptr) {
      if (open()) {
        set_remark("");
        continue;
      }
      if (remark().empty()) {
        set_remark("gamepad" + (which_.empty() ? std::string() : ":" + which_) + " is not there; plug it in");
        spdlog::warn("{}", remark());
      }
      for (auto waited = 0ms; waited < reopen_after && !stopping_; waited += 20ms) std::this_thread::sleep_for(20ms);
      continue;
    }
    bool there = false;
    {
      std::lock_guard lock(api_->mutex);
      api_->update();
      api_->flush_events(0, 0xFFFF);  // no other code reads them
      there = api_->attached(pad_) != 0;
      if (there) {
        const auto axis = [&](sdl::Axis x) { return deflection(api_->axis(pad_, x)); };
        const auto pressed = [&](sdl::Button x) { return api_->button(pad_, x) != 0; };
        RateSample s;
        s.v = Vec3(axis(sdl::left_x), -axis(sdl::left_y), axis(sdl::trigger_right) - axis(sdl::trigger_left));
        s.w = Vec3(-axis(sdl::right_y), double(pressed(sdl::shoulder_right)) - double(pressed(sdl::shoulder_left)),
                   -axis(sdl::right_x));
        s.button1 = pressed(sdl::a);
        s.button2 = pressed(sdl::b);
        deliver(s);
      }
    }
    if (!there) {
      lost();
      close();
      continue;
    }
    std::this_thread::sleep_for(period);
  }
  close();
  lost();
}

}  // namespace insula
