// SPDX-License-Identifier: GPL-3.0-or-later
// Looking for devices of each kind. Not while a device of that kind is in use by this process.
#pragma once
#include "haptic_server/devices/device_kinds.h"

namespace insula {

DeviceSearch find_touch();
DeviceSearch find_forcedimension();
DeviceSearch find_haply();
DeviceSearch find_spacemouse();
DeviceSearch find_gamepads();

}  // namespace insula
