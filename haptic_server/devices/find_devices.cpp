// SPDX-License-Identifier: GPL-3.0-or-later
// Asks each library and service for its connected devices.
#include "haptic_server/devices/find_devices.h"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cstdlib>
#include <cstring>
#include <set>

#include "haptic_server/devices/forcedimension_api.h"
#include "haptic_server/devices/gamepad.h"
#include "haptic_server/devices/haply.h"
#include "haptic_server/devices/openhaptics_api.h"
#include "haptic_server/devices/spacemouse.h"
#include "haptic_server/devices/web_socket_client.h"

namespace fs = std::filesystem;

namespace insula {
namespace {

std::string text_of(const char* text) { return text != nullptr ? text : ""; }

/// Names from the maker's setup program: NAME.config in its folder. The library itself cannot list them.
std::set<std::string> touch_names() {
  std::set<std::string> names;
  std::vector<fs::path> folders;
  if (const char* home = std::getenv("GTDD_HOME")) folders.emplace_back(fs::path(home) / "config");
  if (const char* home = std::getenv("HOME")) folders.emplace_back(fs::path(home) / ".3dsystems" / "config");
  folders.emplace_back("/usr/share/3DSystems/config");
  for (const fs::path& folder : folders) {
    std::error_code error;
    for (fs::directory_iterator i(folder, error), end; !error && i != end; i.increment(error))
      if (i->path().extension() == ".config") names.insert(i->path().stem().string());
    if (!names.empty()) break;
  }
  return names;
}

}  // namespace

DeviceSearch find_touch() {
  DeviceSearch found;
  const auto api = hd::Api::shared();
  if (!api->library.loaded()) {
    found.missing = api->library.error();
    return found;
  }
  std::set<std::string> names = touch_names();
  if (names.empty()) names.insert("");
  for (const std::string& name : names) {
    while (api->get_error().code != hd::success) {
    }
    const hd::Handle handle = api->init_device(name.empty() ? nullptr : name.c_str());
    if (api->get_error().code != hd::success || handle == hd::invalid_handle) continue;
    api->make_current(handle);
    const std::string model = text_of(api->get_string(hd::device_model_type)),
                      serial = text_of(api->get_string(hd::device_serial_number));
    found.devices.push_back(
        {name, fmt::format("{}{}", model.empty() ? "arm" : model, serial.empty() ? "" : ", serial number " + serial)});
    api->disable_device(handle);
  }
  return found;
}

DeviceSearch find_forcedimension() {
  DeviceSearch found;
  const auto api = dhd::Api::shared();
  if (!api->library.loaded()) {
    found.missing = api->library.error();
    return found;
  }
  const int count = std::clamp(api->device_count(), 0, 16);
  for (int i = 0; i < count; ++i) {
    if (api->open_id(char(i)) < 0) {
      found.devices.push_back({"#" + std::to_string(i), "used by another program, or not ready"});
      continue;
    }
    unsigned short serial = 0;
    const bool numbered = api->serial_number != nullptr && api->open_serial != nullptr &&
                          !dhd::failed(api->serial_number(&serial, char(i))) && serial > 0;
    found.devices.push_back(
        {numbered ? std::to_string(serial) : "#" + std::to_string(i), text_of(api->system_name(char(i)))});
    api->close(char(i));
  }
  return found;
}

DeviceSearch find_haply() {
  using namespace std::chrono_literals;
  DeviceSearch found;
  WebSocketClient service;
  std::string_view text;
  HaplyState state;
  std::string why;
  if (!service.connect(HaplyDevice::url(), 1000ms) || !service.receive(text, 1000ms)) {
    found.may_come = true;
    found.missing = "no Haply service at " + HaplyDevice::url() + ": " + service.error();
    return found;
  }
  if (!parse_haply(text, state, why)) {
    found.missing = "what answers at " + HaplyDevice::url() + " is no Haply service: " + why;
    return found;
  }
  for (std::size_t i = 0; i < state.arms.size(); ++i) {
    const HaplyArm& arm = state.arms[i];
    std::string label = arm.type.empty() ? "inverse3" : arm.type;
    if (!arm.handedness.empty()) label += ", " + arm.handedness + " hand";
    if (!arm.ready) label += ", not ready";
    if (i < state.grips.size()) label += ", with grip " + state.grips[i].id;
    found.devices.push_back({arm.id, label});
  }
  return found;
}

DeviceSearch find_spacemouse() {
  DeviceSearch found;
  const auto api = spnav::Api::shared();
  if (!api->library.loaded()) {
    found.missing = api->library.error();
    return found;
  }
  if (api->open() == -1) {
    found.may_come = true;
    found.missing = "the daemon spacenavd does not answer";
    return found;
  }
  char name[128] = "";
  const int length = api->device_name != nullptr ? api->device_name(name, int(sizeof name)) : 0;
  // An old daemon, or one without a device, returns -1 or an empty name.
  if (api->device_name == nullptr) found.devices.push_back({"", "whatever spacenavd has"});
  else if (length > 0) found.devices.push_back({"", std::string(name, ::strnlen(name, sizeof name))});
  api->close();
  return found;
}

DeviceSearch find_gamepads() {
  DeviceSearch found;
  const auto api = sdl::Api::shared();
  if (!api->library.loaded() || !api->ready) {
    found.missing = api->library.loaded() ? "SDL2 does not start" : api->library.error();
    return found;
  }
  std::lock_guard lock(api->mutex);
  api->update();
  for (int i = 0; i < api->count(); ++i)
    if (api->is_controller(i))
      found.devices.push_back({"#" + std::to_string(found.devices.size()), text_of(api->name_of(i))});
  return found;
}

}  // namespace insula
