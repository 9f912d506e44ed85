// SPDX-License-Identifier: GPL-3.0-or-later
// The kinds of devices by name.
#pragma once
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "haptic_server/devices/arm_model.h"

namespace insula {

/// Who moves the hand of a device.
enum class HandSource {
  person,            ///< a real device: nobody here
  motion_or_viewer,  ///< the scene's scripted motion until a viewer takes the hand over
  viewer,            ///< poses from the viewer only
};

struct DeviceChoice {
  std::unique_ptr<Device> device;
  HandSource source = HandSource::person;
};

/// Names that make_device knows, for help texts.
std::vector<std::string> device_kinds();
/// hand: 0 left, 1 right. Throws InputError that lists the kinds when there is no such kind.
DeviceChoice make_device(std::string_view kind, int hand);
/// An Omni in a slightly trembling hand, as `simulated` is.
ArmParameters simulated_arm(int hand);

}  // namespace insula
