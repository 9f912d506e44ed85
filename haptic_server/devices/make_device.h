// SPDX-License-Identifier: GPL-3.0-or-later
// Creates a device from the words of an option.
#pragma once
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "haptic_server/devices/arm_model.h"

namespace insula {

/// Source of a hand's motion.
enum class HandSource {
  person,            ///< a real device: a person
  motion_or_viewer,  ///< the scene's scripted motion, until a viewer takes the hand over
  viewer,            ///< only poses from the viewer
};

struct DeviceChoice {
  std::unique_ptr<Device> device;
  HandSource source = HandSource::person;
};

/// One requested device: "touch", or "touch:Left Device" for a certain one.
struct DeviceWish {
  std::string kind;
  std::string which;

  /// The text that names it.
  std::string text() const { return which.empty() ? kind : kind + ":" + which; }
  /// Name of its calibration. A device without a name of its own gets the name of its hand.
  std::string calibration_name(int hand) const {
    return which.empty() ? kind + (hand == 0 ? " left" : " right") : text();
  }
};

/// Reads "KIND[:WHICH][, KIND[:WHICH]]...", best first. WHICH ends at the next comma, and quotes around it are removed.
/// Throws InputError with a list of the kinds if one is unknown.
std::vector<DeviceWish> parse_device_wishes(std::string_view text);

/// The kinds of devices, for help texts.
std::vector<std::string> device_kinds();
/// hand: 0 left, 1 right. Takes the first device that is connected, or else the last one. A single device is taken even
/// if it is not connected. Reads the device's calibration. Throws InputError.
DeviceChoice make_device(std::string_view wishes, int hand);
/// The device that make_device takes.
DeviceWish choose_device(const std::vector<DeviceWish>& wishes);
/// The arm of the device `simulated`: an Omni in a slightly trembling hand.
ArmParameters simulated_arm(int hand);

}  // namespace insula
