// SPDX-License-Identifier: GPL-3.0-or-later
// Search for devices of each kind. Must not be called while this process uses a device of that kind.
#pragma once
#include "haptic_server/devices/device_kinds.h"

namespace insula {

DeviceSearch find_touch();
DeviceSearch find_forcedimension();
DeviceSearch find_haply();
DeviceSearch find_spacemouse();
DeviceSearch find_gamepads();

}  // namespace insula
