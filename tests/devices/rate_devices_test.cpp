// SPDX-License-Identifier: GPL-3.0-or-later
// SpaceMouse against a stub libspnav.so, gamepads as virtual joysticks of the real SDL2: both move a simulated arm.
#include <dlfcn.h>

#include "core/base/input_error.h"
#include "haptic_server/devices/gamepad.h"
#include "haptic_server/devices/spacemouse.h"
#include "tests/devices/device_bench.h"

namespace insula {
namespace {

/// Lets the arm live on in real time until the condition holds.
bool live(RateDevice& device, const std::function<bool(const DeviceReading&)>& condition,
          std::chrono::milliseconds patience = std::chrono::seconds(20)) {
  return testing::wait_for(
      [&] {
        device.advance(1e-3);
        return condition(device.read());
      },
      patience);
}

class SpaceMouse : public testing::DeviceBench {};

TEST_F(SpaceMouse, MovesTheHandAsItIsPushed) {
  SpaceMouseDevice device(1);
  device.start();
  EXPECT_EQ(device.profile().name, "spacemouse");
  device.face(from_rotation_vector(Vec3(0, 0, std::acos(0.0))));  // looks along -x
  device.place(Pose(), Vec3::Zero(), Vec3::Constant(0.16));
  ASSERT_TRUE(live(device, [](const DeviceReading& r) { return r.connected; }));
  put(arm(0).p, 0, 0, 350);  // away: into the picture
  ASSERT_TRUE(live(device, [](const DeviceReading& r) { return r.pose.p.x() < -0.01; }));
  EXPECT_LT(device.read().pose.p.tail<2>().norm(), 1e-3);
  EXPECT_LT(device.read().v.norm(), 0.1);
  put(arm(0).p, 0, 0, 0);
  ASSERT_TRUE(live(device, [](const DeviceReading& r) { return r.v.norm() < 2e-3; }));
  put(arm(0).v, 0, 350, 0);  // turned about up
  arm(0).buttons = 3;
  ASSERT_TRUE(live(
      device, [](const DeviceReading& r) { return rotation_vector(r.pose.q).z() > 0.2 && r.button1 && r.button2; }));
  arm(0).buttons = 1;
  put(arm(0).v, 0, 0, 0);
  EXPECT_TRUE(live(device, [](const DeviceReading& r) { return r.button1 && !r.button2; }));
}

TEST_F(SpaceMouse, StaysInReachAndWaitsWhereItIsHeldBack) {
  SpaceMouseDevice device(1);
  device.start();
  device.place(Pose(), Vec3::Zero(), Vec3::Constant(10));
  put(arm(0).p, 35000, 0, 0);  // more than there is
  double fastest = 0;
  for (int k = 0; k < 400; ++k) {  // pushes against a wall that yields by only 2 mm
    device.write(Vec3(std::min(0.0, -1600 * (device.read().pose.p.x() - 0.002)), 0, 0), Vec3::Zero());
    device.advance(1e-3);
    fastest = std::max(fastest, device.read().v.norm());
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
  }
  EXPECT_LT(device.read().pose.p.x(), 0.004 + 1e-4);  // 8 mm of leash at 400 N/m are 3.2 N
  EXPECT_GT(device.read().pose.p.x(), 0.003);
  EXPECT_LT(fastest, 0.08);
  device.write(Vec3::Zero(), Vec3::Zero());
  for (int k = 0; k < 4000; ++k) device.advance(1e-3);
  EXPECT_LT(device.read().pose.p.x(), 0.1005);
}

TEST_F(SpaceMouse, UnpluggedAndPluggedInAgain) {
  SpaceMouseDevice device(1);
  device.start();
  device.place(Pose(), Vec3::Zero(), Vec3::Constant(0.16));
  put(arm(0).p, 350, 0, 0);
  ASSERT_TRUE(live(device, [](const DeviceReading& r) { return r.pose.p.x() > 0.005; }));
  arm(0).plugged = 0;
  ASSERT_TRUE(live(device, [](const DeviceReading& r) { return !r.connected; }));
  put(arm(0).p, 0, 0, 0);
  arm(0).plugged = 1;
  ASSERT_TRUE(live(device, [](const DeviceReading& r) { return r.connected; }));
  stubs->daemon = 0;  // the daemon ends
  ASSERT_TRUE(live(device, [](const DeviceReading& r) { return !r.connected; }));
  ASSERT_TRUE(
      testing::wait_for([&] { return device.remark().find("spacenavd does not answer") != std::string::npos; }));
  stubs->daemon = 1;
  EXPECT_TRUE(live(device, [](const DeviceReading& r) { return r.connected; }));
  EXPECT_EQ(device.remark(), "");
}

TEST_F(SpaceMouse, ServesOneHandOnly) {
  SpaceMouseDevice left(0), right(1);
  left.start();
  EXPECT_THROW(right.start(), InputError);
  left.stop();
  EXPECT_NO_THROW(right.start());
}

TEST_F(SpaceMouse, WithoutTheLibraryItSaysHowToGetIt) {
  ::setenv("INSULA_LIBSPNAV", "/nowhere/libspnav.so", 1);
  SpaceMouseDevice device(0);
  EXPECT_THROW(device.start(), InputError);
}

/// SDL_VirtualJoystickDesc of SDL 2.24 and later.
struct VirtualPad {
  std::uint16_t version = 1, type = 1, axes = 6, buttons = 15, hats = 0, vendor = 0, product = 0, padding = 0;
  std::uint32_t button_mask = 0, axis_mask = 0;
  const char* name = nullptr;
  void* userdata = nullptr;
  void (*update)(void*) = nullptr;
  void (*set_player)(void*, int) = nullptr;
  int (*rumble)(void*, std::uint16_t, std::uint16_t) = nullptr;
  int (*rumble_triggers)(void*, std::uint16_t, std::uint16_t) = nullptr;
  int (*set_led)(void*, std::uint8_t, std::uint8_t, std::uint8_t) = nullptr;
  int (*send_effect)(void*, const void*, int) = nullptr;
};

class Gamepad : public testing::DeviceBench {
 protected:
  void SetUp() override {
    void* library = dlopen("libSDL2-2.0.so.0", RTLD_NOW);
    attach_ = library != nullptr ? reinterpret_cast<decltype(attach_)>(dlsym(library, "SDL_JoystickAttachVirtualEx"))
                                 : nullptr;
    if (attach_ == nullptr) GTEST_SKIP() << "needs SDL 2.24 or later (libsdl2-2.0-0)";
    detach_ = reinterpret_cast<decltype(detach_)>(dlsym(library, "SDL_JoystickDetachVirtual"));
    open_ = reinterpret_cast<decltype(open_)>(dlsym(library, "SDL_JoystickOpen"));
    close_ = reinterpret_cast<decltype(close_)>(dlsym(library, "SDL_JoystickClose"));
    axis_ = reinterpret_cast<decltype(axis_)>(dlsym(library, "SDL_JoystickSetVirtualAxis"));
    button_ = reinterpret_cast<decltype(button_)>(dlsym(library, "SDL_JoystickSetVirtualButton"));
    api = sdl::Api::shared();
    ASSERT_TRUE(api->ready) << api->library.error();
  }
  /// Plugs one in; returns a handle for moving it.
  void* plug(const char* name) {
    VirtualPad pad;
    pad.name = name;
    std::lock_guard lock(api->mutex);
    const int index = attach_(&pad);
    EXPECT_GE(index, 0);
    return open_(index);
  }
  void unplug(int index, void* pad) {
    std::lock_guard lock(api->mutex);
    close_(pad);
    EXPECT_EQ(detach_(index), 0);
  }
  void deflect(void* pad, int axis, int value) {
    std::lock_guard lock(api->mutex);
    axis_(pad, axis, std::int16_t(value));
  }
  void press(void* pad, int button, bool down) {
    std::lock_guard lock(api->mutex);
    button_(pad, button, down ? 1 : 0);
  }
  void* rest(void* pad) {  // triggers at rest are at the low end of a joystick's axis
    deflect(pad, sdl::trigger_left, -32768);
    deflect(pad, sdl::trigger_right, -32768);
    return pad;
  }

  std::shared_ptr<sdl::Api> api;

 private:
  int (*attach_)(const VirtualPad*) = nullptr;
  int (*detach_)(int) = nullptr;
  void* (*open_)(int) = nullptr;
  void (*close_)(void*) = nullptr;
  int (*axis_)(void*, int, std::int16_t) = nullptr;
  int (*button_)(void*, int, std::uint8_t) = nullptr;
};

TEST_F(Gamepad, MovesTheHandAndComesBackWhenPluggedInAgain) {
  GamepadDevice device("", 0);
  device.start();
  ASSERT_TRUE(testing::wait_for([&] { return device.remark().find("is not there; plug it in") != std::string::npos; }));
  void* pad = rest(plug("Pad A"));
  device.place(Pose(), Vec3::Zero(), Vec3::Constant(0.16));
  ASSERT_TRUE(live(device, [](const DeviceReading& r) { return r.connected; }));
  EXPECT_EQ(device.remark(), "");
  deflect(pad, sdl::left_x, 32767);
  ASSERT_TRUE(live(device, [](const DeviceReading& r) { return r.pose.p.x() > 0.005; }));
  EXPECT_LT(device.read().pose.p.tail<2>().norm(), 1e-3);
  deflect(pad, sdl::left_x, 2000);  // a worn stick does not come back to zero
  deflect(pad, sdl::left_y, -32768);
  press(pad, sdl::a, true);
  ASSERT_TRUE(live(device, [](const DeviceReading& r) { return r.pose.p.y() > 0.005 && r.button1 && !r.button2; }));
  unplug(0, pad);
  ASSERT_TRUE(live(device, [](const DeviceReading& r) { return !r.connected; }));
  pad = rest(plug("Pad A"));
  EXPECT_TRUE(live(device, [](const DeviceReading& r) { return r.connected; }));
  device.stop();
  unplug(0, pad);
}

TEST_F(Gamepad, TwoOfThemByNameByNumberOrAsTheyCome) {
  void* a = rest(plug("Pad A"));
  void* b = rest(plug("Pad B"));
  {
    GamepadDevice left("Pad B", 0), right("#0", 1), none("", 0);
    left.start();
    right.start();
    for (GamepadDevice* d : {&left, &right}) d->place(Pose(), Vec3::Zero(), Vec3::Constant(0.16));
    ASSERT_TRUE(live(left, [&](const DeviceReading& r) { return r.connected && right.read().connected; }));
    none.start();
    press(b, sdl::b, true);
    EXPECT_TRUE(live(left, [&](const DeviceReading& r) { return r.button2; }));
    EXPECT_FALSE(right.read().button2);
    EXPECT_FALSE(none.read().connected);
    EXPECT_NE(none.remark(), "");
  }
  GamepadDevice left("", 0), right("", 1);
  left.start();
  right.start();
  for (GamepadDevice* d : {&left, &right}) d->place(Pose(), Vec3::Zero(), Vec3::Constant(0.16));
  EXPECT_TRUE(live(left, [&](const DeviceReading& r) { return r.connected && right.read().connected; }));
  left.stop();
  right.stop();
  unplug(1, b);
  unplug(0, a);
}

TEST_F(Gamepad, WithoutTheLibraryItSaysHowToGetIt) {
  api.reset();
  ::setenv("INSULA_LIBSDL2", "/nowhere/libSDL2.so", 1);
  GamepadDevice device("", 0);
  EXPECT_THROW(device.start(), InputError);
  ::unsetenv("INSULA_LIBSDL2");
}

}  // namespace
}  // namespace insula
