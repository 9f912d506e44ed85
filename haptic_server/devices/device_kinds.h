// SPDX-License-Identifier: GPL-3.0-or-later
// All kinds of devices: description, search for connected ones, and how to install what is missing.
#pragma once
#include <functional>
#include <string>
#include <string_view>
#include <vector>

#include "haptic_server/devices/calibration.h"
#include "haptic_server/devices/make_device.h"

namespace insula {

/// A device that is plugged in now.
struct FoundDevice {
  std::string which;  ///< its name after the kind and a colon; empty: there is only one, or it needs no name
  std::string label;  ///< for people
};

struct DeviceSearch {
  std::string missing;  ///< reason why the kind cannot be used at all (a library, a service); empty: it can
  std::vector<FoundDevice> devices;
  bool may_come = false;  ///< a service is missing that may be started later
};

struct DeviceKind {
  std::string name;
  std::string summary;
  bool force = false;  ///< gives forces to the hand
  bool real = false;   ///< a physical device
  std::string how_to_get;
  DeviceCalibration calibration;  ///< the default without a stored calibration
  std::function<DeviceSearch()> search;
  std::function<DeviceChoice(const std::string& which, int hand, const DeviceCalibration&)> make;
};

/// In the order in which they are listed.
const std::vector<DeviceKind>& all_device_kinds();
/// nullptr if there is none with that name.
const DeviceKind* find_device_kind(std::string_view name);

}  // namespace insula
