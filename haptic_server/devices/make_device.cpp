// SPDX-License-Identifier: GPL-3.0-or-later
// Reads the requested devices and chooses among them.
#include "haptic_server/devices/make_device.h"

#include <algorithm>

#include "core/base/input_error.h"
#include "core/base/text.h"
#include "haptic_server/devices/device_kinds.h"

namespace insula {
namespace {

bool plugged_in(const DeviceWish& wish) {
  const DeviceSearch found = find_device_kind(wish.kind)->search();
  if (!found.missing.empty()) return false;
  const std::size_t there = found.devices.size();
  if (wish.which.empty()) return there > 0;
  if (wish.which.front() == '#') {
    for (std::size_t i = 0; i < there; ++i)
      if (wish.which == "#" + std::to_string(i)) return true;
    return false;
  }
  const std::string id = wish.which.substr(0, wish.which.find('+'));  // a Haply arm without its grip
  return std::any_of(found.devices.begin(), found.devices.end(),
                     [&](const FoundDevice& d) { return d.which == id || d.label == wish.which; });
}

}  // namespace

std::vector<std::string> device_kinds() {
  std::vector<std::string> names;
  for (const DeviceKind& kind : all_device_kinds()) names.push_back(kind.name);
  return names;
}

ArmParameters simulated_arm(int hand) {
  ArmParameters p;
  p.profile = omni_profile();
  // Physiological tremor, tens of micrometres; more than half a count of the encoders, so that a held arm does not
  // appear frozen.
  p.tremor_m = 40e-6;
  p.tremor_rad = 0.3e-3;
  p.tremor_seed = hand;
  return p;
}

std::vector<DeviceWish> parse_device_wishes(std::string_view text) {
  std::vector<DeviceWish> wishes;
  while (true) {
    const std::size_t comma = text.find(',');
    const std::string_view word = trim(text.substr(0, comma));
    const std::size_t colon = word.find(':');
    DeviceWish wish;
    wish.kind = std::string(trim(word.substr(0, colon)));
    if (colon != std::string_view::npos) {
      std::string_view which = trim(word.substr(colon + 1));
      if (which.size() >= 2 && which.front() == '"' && which.back() == '"') which = which.substr(1, which.size() - 2);
      if (which.empty()) throw InputError(in_quotes(text) + ": nothing stands after the colon");
      wish.which = std::string(which);
    }
    const DeviceKind* kind = find_device_kind(wish.kind);
    if (kind == nullptr)
      throw InputError("no device " + in_quotes(wish.kind) + "; there are: " + joined(device_kinds(), " "));
    if (!wish.which.empty() && (!kind->real || kind->name == "spacemouse"))
      throw InputError("device " + wish.kind + " takes no name (it has " + in_quotes(wish.which) + ")");
    wishes.push_back(std::move(wish));
    if (comma == std::string_view::npos) return wishes;
    text.remove_prefix(comma + 1);
  }
}

DeviceWish choose_device(const std::vector<DeviceWish>& wishes) {
  for (std::size_t i = 0; i + 1 < wishes.size(); ++i)
    if (plugged_in(wishes[i])) return wishes[i];
  return wishes.back();
}

DeviceChoice make_device(std::string_view wishes, int hand) {
  const DeviceWish wish = choose_device(parse_device_wishes(wishes));
  const DeviceKind& kind = *find_device_kind(wish.kind);
  const DeviceCalibration calibration =
      kind.real ? load_calibration(wish.calibration_name(hand), kind.calibration) : kind.calibration;
  return kind.make(wish.which, hand, calibration);
}

}  // namespace insula
