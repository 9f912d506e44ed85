// SPDX-License-Identifier: GPL-3.0-or-later
// From the words that choose a device to the device.
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

/// One wish: "touch", or "touch:Left Device" for a certain one.
struct DeviceWish {
  std::string kind;
  std::string which;

  /// As it is written.
  std::string text() const { return which.empty() ? kind : kind + ":" + which; }
  /// What its calibration is kept under: a device without a name of its own is called after the hand that it serves.
  std::string calibration_name(int hand) const {
    return which.empty() ? kind + (hand == 0 ? " left" : " right") : text();
  }
};

/// Reads "KIND[:WHICH][, KIND[:WHICH]]...", best first. Which one goes to the next comma; quotes around it are taken
/// off. Throws InputError that lists the kinds when one is unknown.
std::vector<DeviceWish> parse_device_wishes(std::string_view text);

/// Names that a wish may begin with, for help texts.
std::vector<std::string> device_kinds();
/// hand: 0 left, 1 right. Of several wishes the first that is plugged in, else the last; a single one is taken as it is
/// and waited for. Reads the device's calibration. Throws InputError.
DeviceChoice make_device(std::string_view wishes, int hand);
/// The wish that make_device takes.
DeviceWish choose_device(const std::vector<DeviceWish>& wishes);
/// An Omni in a slightly trembling hand, as `simulated` is.
ArmParameters simulated_arm(int hand);

}  // namespace insula
