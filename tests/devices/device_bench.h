// SPDX-License-Identifier: GPL-3.0-or-later
// A bench with stand-ins of devices, a folder for calibrations, and a caller that uses a device as the servo does.
#pragma once
#include <gtest/gtest.h>

#include <chrono>
#include <filesystem>
#include <functional>
#include <string>
#include <thread>

#include "haptic_server/devices/device.h"
#include "tests/devices/stub_board.h"

namespace insula::testing {

using namespace std::chrono_literals;

/// Limit of every wait. It is far longer than any normal delay.
template <class Condition>
bool wait_for(Condition condition, std::chrono::milliseconds patience = 20s) {
  const auto end = std::chrono::steady_clock::now() + patience;
  while (std::chrono::steady_clock::now() < end) {
    if (condition()) return true;
    std::this_thread::sleep_for(1ms);
  }
  return condition();
}

/// Two arms are plugged in at first, "Left Device" and "Right Device".
class DeviceBench : public ::testing::Test {
 protected:
  DeviceBench() {
    std::filesystem::create_directories(folder);
    // The stubs of this process map the file once, so every test works on the same one.
    static StubBoard* const mapped = [this] {
      const std::string file =
          (std::filesystem::temp_directory_path() / ("insula_board_" + std::to_string(::getpid()))).string();
      ::setenv("INSULA_STUB_BOARD", file.c_str(), 1);
      return map_board(file.c_str());
    }();
    stubs = mapped;
    const std::string libraries = INSULA_BINARY_DIR "/tests/";
    ::setenv("INSULA_LIBHD", (libraries + "stub_libhd.so").c_str(), 1);
    ::setenv("INSULA_LIBDHD", (libraries + "stub_libdhd.so").c_str(), 1);
    ::setenv("INSULA_LIBSPNAV", (libraries + "stub_libspnav.so").c_str(), 1);
    ::setenv("INSULA_HAPLY_URL", "ws://127.0.0.1:9", 1);
    ::setenv("XDG_CONFIG_HOME", folder.c_str(), 1);
    ::setenv("GTDD_HOME", folder.c_str(), 1);
    for (StubArm& a : stubs->arm) {
      a.plugged = a.serial = a.type = a.buttons = a.calibration_state = a.open = 0;
      for (auto* numbers : {a.p, a.v, a.force, a.torque})
        for (int i = 0; i < 3; ++i) numbers[i] = 0;
      for (int i = 0; i < 4; ++i) a.q[i] = i == 0 ? 1 : 0;
      a.name[0] = 0;
    }
    stubs->daemon = 1;
    set(0, "Left Device", 1001);
    set(1, "Right Device", 1002);
  }
  ~DeviceBench() override {
    std::error_code ignored;
    std::filesystem::remove_all(folder, ignored);
  }

  void set(int i, const char* name, int serial) {
    StubArm& a = stubs->arm[i];
    std::snprintf(a.name, sizeof a.name, "%s", name);
    std::snprintf(a.model, sizeof a.model, "Touch");
    a.serial = serial;
    a.type = 33;
    a.max_force = 3.3;
    a.plugged = 1;
  }
  StubArm& arm(int i) { return stubs->arm[i]; }
  static void put(std::atomic<double>* into, double x, double y, double z) { into[0] = x, into[1] = y, into[2] = z; }
  Vec3 force(int i) { return {arm(i).force[0], arm(i).force[1], arm(i).force[2]}; }
  Vec3 torque(int i) { return {arm(i).torque[0], arm(i).torque[1], arm(i).torque[2]}; }

  /// Calls the device a thousand times a second with this force until the condition holds.
  static bool serve(Device& device, const Vec3& push, const std::function<bool(const DeviceReading&)>& condition,
                    std::chrono::milliseconds patience = 20s) {
    return wait_for(
        [&] {
          const DeviceReading r = device.read();
          device.write(push, Vec3::Zero());
          return condition(r);
        },
        patience);
  }
  static bool connected(Device& device, bool wanted = true) {
    return serve(device, Vec3::Zero(), [&](const DeviceReading& r) { return r.connected == wanted; });
  }

  std::string folder =
      (std::filesystem::temp_directory_path() / ("insula_devices_" + std::to_string(::getpid()))).string();
  StubBoard* stubs = nullptr;
};

}  // namespace insula::testing
