// SPDX-License-Identifier: GPL-3.0-or-later
// The kinds of devices by name.
#include "haptic_server/devices/make_device.h"

#include "core/base/input_error.h"
#include "haptic_server/devices/simulated.h"

namespace insula {

std::vector<std::string> device_kinds() { return {"simulated", "mouse"}; }

ArmParameters simulated_arm(int hand) {
  ArmParameters p;
  p.profile = omni_profile();
  // Physiological tremor, tens of micrometres; more than half a count of the encoders, so that a held arm never reads as dead.
  p.tremor_m = 40e-6;
  p.tremor_rad = 0.3e-3;
  p.tremor_seed = hand;
  return p;
}

DeviceChoice make_device(std::string_view kind, int hand) {
  ArmParameters p = simulated_arm(hand);
  if (kind == "simulated") return {std::make_unique<SimulatedDevice>(p), HandSource::motion_or_viewer};
  if (kind == "mouse") {
    p.profile.name = "mouse";
    return {std::make_unique<SimulatedDevice>(p), HandSource::viewer};
  }
  std::string text = "no device \"" + std::string(kind) + "\"; there are:";
  for (const std::string& k : device_kinds()) text += " " + k;
  throw InputError(text);
}

}  // namespace insula
