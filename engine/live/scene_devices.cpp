// SPDX-License-Identifier: GPL-3.0-or-later
// Checks of the devices that a scene or a command line names.
#include "engine/live/scene_devices.h"

#include "core/base/input_error.h"
#include "core/sim/settings.h"
#include "haptic_server/devices/device_kinds.h"

namespace insula {

void check_scene_devices(const Scene& scene, Diagnostics& diagnostics) {
  for (const DeviceSettings* settings : scene.all<DeviceSettings>())
    for (const Param<std::string>* hand : {&settings->left, &settings->right}) {
      try {
        parse_device_wishes((*hand)());
      } catch (const InputError& e) {
        diagnostics.error(hand->pos(), hand->name() + ": " + e.what());
      }
    }
}

std::string scene_device(const Scene& scene, int hand) {
  const auto settings = scene.all<DeviceSettings>();
  if (settings.empty()) return {};
  const Param<std::string>& wish = hand == 0 ? settings.front()->left : settings.front()->right;
  return wish.given() ? wish() : std::string();
}

std::string device_obstacle(const std::string& wishes) {
  try {
    const DeviceWish wish = choose_device(parse_device_wishes(wishes));
    const DeviceKind& kind = *find_device_kind(wish.kind);
    const DeviceSearch found = kind.search();
    if (found.missing.empty() || found.may_come) return {};
    return wish.kind + ": " + found.missing + "; to get it: " + kind.how_to_get;
  } catch (const InputError& e) {
    return e.what();
  }
}

}  // namespace insula
