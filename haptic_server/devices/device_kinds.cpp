// SPDX-License-Identifier: GPL-3.0-or-later
// The table of kinds. A new driver is one entry here.
#include "haptic_server/devices/device_kinds.h"

#include "haptic_server/devices/find_devices.h"
#include "haptic_server/devices/forcedimension.h"
#include "haptic_server/devices/gamepad.h"
#include "haptic_server/devices/haply.h"
#include "haptic_server/devices/openhaptics.h"
#include "haptic_server/devices/simulated.h"
#include "haptic_server/devices/spacemouse.h"

namespace insula {
namespace {

DeviceSearch always() { return {{}, {{"", "always there"}}, false}; }

std::vector<DeviceKind> table() {
  using Calibration = const DeviceCalibration&;
  using Which = const std::string&;
  return {
      {.name = "simulated",
       .summary = "a simulated arm, moved by the scene's motion until a viewer takes it over",
       .how_to_get = {},
       .calibration = {},
       .search = always,
       .make =
           [](Which, int hand, Calibration) {
             return DeviceChoice{std::make_unique<SimulatedDevice>(simulated_arm(hand)), HandSource::motion_or_viewer};
           }},
      {.name = "mouse",
       .summary = "a simulated arm, moved with the mouse in a viewer",
       .how_to_get = {},
       .calibration = {},
       .search = always,
       .make =
           [](Which, int hand, Calibration) {
             ArmParameters p = simulated_arm(hand);
             p.profile.name = "mouse";
             return DeviceChoice{std::make_unique<SimulatedDevice>(p), HandSource::viewer};
           }},
      {.name = "touch",
       .summary = "Phantom Omni, Touch, Touch X, Premium (OpenHaptics)",
       .force = true,
       .real = true,
       .how_to_get = hd::how_to_get(),
       .calibration = OpenHapticsDevice::default_calibration(),
       .search = find_touch,
       .make =
           [](Which which, int, Calibration c) {
             return DeviceChoice{std::make_unique<OpenHapticsDevice>(which, c), HandSource::person};
           }},
      {.name = "forcedimension",
       .summary = "omega, delta, sigma, Falcon (Force Dimension's SDK)",
       .force = true,
       .real = true,
       .how_to_get = dhd::how_to_get(),
       .calibration = ForceDimensionDevice::default_calibration(),
       .search = find_forcedimension,
       .make =
           [](Which which, int, Calibration c) {
             return DeviceChoice{std::make_unique<ForceDimensionDevice>(which, c), HandSource::person};
           }},
      {.name = "haply",
       .summary = "Haply Inverse3 with Verse Grip (the Haply Inverse Service)",
       .force = true,
       .real = true,
       .how_to_get = how_to_get_haply(),
       .calibration = HaplyDevice::default_calibration(),
       .search = find_haply,
       .make =
           [](Which which, int hand, Calibration c) {
             return DeviceChoice{std::make_unique<HaplyDevice>(which, hand, c), HandSource::person};
           }},
      {.name = "spacemouse",
       .summary = "3Dconnexion SpaceMouse (spacenavd): moves a simulated arm, nothing is felt",
       .real = true,
       .how_to_get = spnav::how_to_get(),
       .calibration = {},
       .search = find_spacemouse,
       .make =
           [](Which, int hand, Calibration c) {
             return DeviceChoice{std::make_unique<SpaceMouseDevice>(hand, c), HandSource::person};
           }},
      {.name = "gamepad",
       .summary = "a gamepad (SDL2): moves a simulated arm, nothing is felt",
       .real = true,
       .how_to_get = sdl::how_to_get(),
       .calibration = {},
       .search = find_gamepads,
       .make =
           [](Which which, int hand, Calibration c) {
             return DeviceChoice{std::make_unique<GamepadDevice>(which, hand, c), HandSource::person};
           }},
  };
}

}  // namespace

const std::vector<DeviceKind>& all_device_kinds() {
  static const std::vector<DeviceKind> kinds = table();
  return kinds;
}

const DeviceKind* find_device_kind(std::string_view name) {
  for (const DeviceKind& kind : all_device_kinds())
    if (kind.name == name) return &kind;
  return nullptr;
}

}  // namespace insula
