// SPDX-License-Identifier: GPL-3.0-or-later
// The tables of kinds. A new driver needs one entry in one of them.
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

using Calibration = const DeviceCalibration&;
using Which = const std::string&;

template <class Arm, class... Arguments>
DeviceChoice moved_by_a_person(Arguments&&... arguments) {
  return {std::make_unique<Arm>(std::forward<Arguments>(arguments)...), HandSource::person};
}

std::vector<DeviceKind> simulated_kinds() {
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
  };
}

/// Arms that apply forces to the hand.
std::vector<DeviceKind> force_kinds() {
  return {
      {.name = "touch",
       .summary = "Phantom Omni, Touch, Touch X, Premium (OpenHaptics)",
       .force = true,
       .real = true,
       .how_to_get = hd::how_to_get(),
       .calibration = OpenHapticsDevice::default_calibration(),
       .search = find_touch,
       .make = [](Which which, int, Calibration c) { return moved_by_a_person<OpenHapticsDevice>(which, c); }},
      {.name = "forcedimension",
       .summary = "omega, delta, sigma, Falcon (Force Dimension's SDK)",
       .force = true,
       .real = true,
       .how_to_get = dhd::how_to_get(),
       .calibration = ForceDimensionDevice::default_calibration(),
       .search = find_forcedimension,
       .make = [](Which which, int, Calibration c) { return moved_by_a_person<ForceDimensionDevice>(which, c); }},
      {.name = "haply",
       .summary = "Haply Inverse3 with Verse Grip (the Haply Inverse Service)",
       .force = true,
       .real = true,
       .how_to_get = how_to_get_haply(),
       .calibration = HaplyDevice::default_calibration(),
       .search = find_haply,
       .make = [](Which which, int hand, Calibration c) { return moved_by_a_person<HaplyDevice>(which, hand, c); }},
  };
}

/// Devices without force output. They only move a simulated arm.
std::vector<DeviceKind> input_kinds() {
  return {
      {.name = "spacemouse",
       .summary = "3Dconnexion SpaceMouse (spacenavd): moves a simulated arm, nothing is felt",
       .real = true,
       .how_to_get = spnav::how_to_get(),
       .calibration = {},
       .search = find_spacemouse,
       .make = [](Which, int hand, Calibration c) { return moved_by_a_person<SpaceMouseDevice>(hand, c); }},
      {.name = "gamepad",
       .summary = "a gamepad (SDL2): moves a simulated arm, nothing is felt",
       .real = true,
       .how_to_get = sdl::how_to_get(),
       .calibration = {},
       .search = find_gamepads,
       .make = [](Which which, int hand, Calibration c) { return moved_by_a_person<GamepadDevice>(which, hand, c); }},
  };
}

std::vector<DeviceKind> table() {
  std::vector<DeviceKind> out;
  for (auto* kinds : {simulated_kinds, force_kinds, input_kinds})
    for (DeviceKind& kind : kinds()) out.push_back(std::move(kind));
  return out;
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
