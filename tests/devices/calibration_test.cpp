// SPDX-License-Identifier: GPL-3.0-or-later
// Calibrations: kept, checked before use; wishes for devices: read.
#include "haptic_server/devices/calibration.h"

#include <fstream>
#include <limits>

#include "core/base/input_error.h"
#include "haptic_server/devices/device_kinds.h"
#include "tests/devices/device_bench.h"
#include "tests/devices/haply_stand_in.h"

namespace insula {
namespace {

class Calibration : public testing::DeviceBench {};

TEST_F(Calibration, IsKeptToTheLastBit) {
  DeviceCalibration c;
  c.axes << 0, 1, 0, -1, 0, 0, 0, 0, 1;
  c.rest = {Vec3(0.1, 1.0 / 3, -0.2), from_rotation_vector(Vec3(0.1, 0.2, 0.3))};
  c.scale = 0.7;
  const auto file = save_calibration("touch:Left Device", c);
  EXPECT_EQ(file.string(), folder + "/insula/devices/touch_Left_Device.json");
  const DeviceCalibration d = load_calibration("touch:Left Device", {});
  EXPECT_EQ(d.axes, c.axes);
  EXPECT_EQ(d.rest.p, c.rest.p);
  EXPECT_EQ(d.rest.q.coeffs(), c.rest.q.coeffs());
  EXPECT_EQ(d.scale, 0.7);
  EXPECT_EQ(load_calibration("touch:Right Device", c).scale, 0.7);  // none: the fallback
}

TEST_F(Calibration, WhatCannotBeIsNeitherKeptNorUsed) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  DeviceCalibration mirrored, skewed, far, turned, fast, infinite;
  mirrored.axes(0, 0) = -1;
  skewed.axes(0, 1) = 0.1;
  far.rest.p.x() = 3;
  turned.rest.q = Quat(2, 0, 0, 0);
  fast.scale = 100;
  infinite.scale = nan;
  for (const DeviceCalibration& c : {mirrored, skewed, far, turned, fast, infinite}) {
    EXPECT_NE(calibration_error(c), "");
    EXPECT_THROW(save_calibration("touch:A", c), InputError);
  }
  EXPECT_FALSE(std::filesystem::exists(calibration_file("touch:A")));
  std::filesystem::create_directories(calibration_folder());
  const std::string good = R"({"axes":[[1,0,0],[0,1,0],[0,0,1]],"rest_p_m":[0,0,0],"rest_q":[1,0,0,0],"scale":1})";
  for (const std::string& bad :
       {std::string("{}"), std::string("no JSON"), std::string(), good.substr(0, good.size() - 2),
        std::string(R"({"axes":[[1,0,0],[0,1,0],[0,0,1]],"rest_p_m":[0,0,0],"rest_q":[1,0,0,0],"scale":1e9})"),
        std::string(R"({"axes":[[1,0],[0,1,0],[0,0,1]],"rest_p_m":[0,0,0],"rest_q":[1,0,0,0],"scale":1})"),
        std::string(R"({"axes":[[1,0,0],[0,1,0],[0,0,1]],"rest_p_m":[0,0,"0"],"rest_q":[1,0,0,0],"scale":1})")}) {
    std::ofstream(calibration_file("touch:A")) << bad;
    try {
      make_device("touch:A", 0);
      FAIL() << bad;
    } catch (const InputError& e) {
      EXPECT_NE(std::string(e.what()).find("touch_A.json"), std::string::npos) << e.what();
    }
  }
  std::ofstream(calibration_file("touch:A")) << good;
  EXPECT_NO_THROW(make_device("touch:A", 0));
}

TEST(DeviceWishes, AreRead) {
  const auto wishes = parse_device_wishes(R"( touch:"Left Device" , forcedimension:#1,haply:049D+61548, mouse)");
  ASSERT_EQ(wishes.size(), 4u);
  EXPECT_EQ(wishes[0].kind, "touch");
  EXPECT_EQ(wishes[0].which, "Left Device");
  EXPECT_EQ(wishes[1].text(), "forcedimension:#1");
  EXPECT_EQ(wishes[2].which, "049D+61548");
  EXPECT_EQ(wishes[3].calibration_name(0), "mouse left");
  EXPECT_EQ(wishes[0].calibration_name(1), "touch:Left Device");
  for (const char* bad :
       {"", "tuch", "touch:", "touch,,mouse", "touch, ", "mouse:1", "spacemouse:2", ":x", "touch:\"\""})
    EXPECT_THROW(parse_device_wishes(bad), InputError) << bad;
}

class Wishes : public testing::DeviceBench {};

TEST_F(Wishes, TheFirstThatIsPluggedInIsTaken) {
  const auto chosen = [](const char* text) { return choose_device(parse_device_wishes(text)).text(); };
  std::filesystem::create_directories(folder + "/config");
  std::ofstream(folder + "/config/Left Device.config") << "";
  EXPECT_EQ(chosen("haply, touch:Left Device, mouse"), "touch:Left Device");
  EXPECT_EQ(chosen("touch:Third Device, mouse"), "mouse");
  EXPECT_EQ(chosen("forcedimension:1002, mouse"), "forcedimension:1002");
  EXPECT_EQ(chosen("forcedimension, touch"), "forcedimension");
  EXPECT_EQ(chosen("forcedimension:#7, forcedimension:#1, touch"), "forcedimension:#1");
  testing::HaplyStandIn service(testing::two_arms());
  ::setenv("INSULA_HAPLY_URL", service.url().c_str(), 1);
  EXPECT_EQ(chosen("haply:FFFF, haply:049D+61548, mouse"), "haply:049D+61548");
  service.stop();
  arm(0).plugged = arm(1).plugged = 0;
  EXPECT_EQ(chosen("touch:Left Device, forcedimension, spacemouse, haply"), "haply");  // none: the last is waited for
  ::setenv("INSULA_LIBHD", "/nowhere/libHD.so", 1);
  EXPECT_EQ(chosen("touch, simulated"), "simulated");
}

TEST_F(Wishes, EveryKindIsMadeUnderItsName) {
  for (const DeviceKind& kind : all_device_kinds())
    EXPECT_EQ(make_device(kind.name, 0).device->profile().name, kind.name);
}

}  // namespace
}  // namespace insula
