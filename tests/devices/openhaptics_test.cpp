// SPDX-License-Identifier: GPL-3.0-or-later
// The OpenHaptics driver against a stub libHD.so.
#include "haptic_server/devices/openhaptics.h"

#include "core/base/input_error.h"
#include "haptic_server/devices/make_device.h"
#include "tests/devices/device_bench.h"

namespace insula {
namespace {

class OpenHaptics : public testing::DeviceBench {};

TEST_F(OpenHaptics, StreamsPosesInThePersonsAxesAndMetres) {
  OpenHapticsDevice device("Left Device");
  device.start();
  EXPECT_EQ(device.remark(), "");
  put(arm(0).p, 10, 20, 30);  // right, up, to the person
  put(arm(0).v, 100, 0, 0);
  const double half = std::sqrt(0.5);
  arm(0).q[0] = half;
  arm(0).q[2] = half;  // a quarter turn about up
  arm(0).buttons = 2;
  ASSERT_TRUE(serve(device, Vec3::Zero(), [](const DeviceReading& r) {
    return r.connected && r.button2 && (r.pose.p - Vec3(0.01, -0.03, 0.02)).norm() < 1e-12 && r.v.x() > 0;
  }));
  const DeviceReading r = device.read();
  EXPECT_FALSE(r.button1);
  EXPECT_NEAR((r.v - Vec3(0.1, 0, 0)).norm(), 0, 1e-12);
  EXPECT_NEAR((rotation_vector(r.pose.q) - Vec3(0, 0, std::acos(0.0))).norm(), 0, 1e-6);
  device.stop();
  EXPECT_FALSE(device.read().connected);
  EXPECT_EQ(arm(0).open, 0);
}

TEST_F(OpenHaptics, LaysItsRestPoseAtTheHandsHomeAsTheMicroscopeSees) {
  OpenHapticsDevice device("");
  device.start();
  put(arm(0).p, 10, 0, 0);
  const Pose home{Vec3(0.1, 0.2, 0.3), from_rotation_vector(Vec3(0.3, 0, 0))};
  device.face(from_rotation_vector(Vec3(0, 0, std::acos(0.0))));  // looks along -x: the person's right is the scene's y
  device.place(home, Vec3::Zero(), Vec3::Zero());
  ASSERT_TRUE(serve(device, Vec3(0, 1, 0), [&](const DeviceReading& r) {
    return r.connected && (r.pose.p - home.p - Vec3(0, 0.01, 0)).norm() < 1e-9 &&
           (force(0) - Vec3(1, 0, 0)).norm() < 1e-9;
  }));  // a push along the scene's y goes to the hand's right
  EXPECT_NEAR(rotation_vector(device.read().pose.q * home.q.conjugate()).norm(), 0, 1e-9);
}

TEST_F(OpenHaptics, TakesItsLimitsFromTheDevice) {
  arm(0).max_force = 7.9;
  std::snprintf(arm(0).model, sizeof arm(0).model, "Touch X");
  OpenHapticsDevice device("Left Device");
  device.start();
  EXPECT_DOUBLE_EQ(device.profile().max_force_N, 7.9);
  EXPECT_DOUBLE_EQ(device.profile().max_slew_N_s, 158);
  EXPECT_DOUBLE_EQ(device.profile().resolution_m, 23e-6);
  EXPECT_NEAR((device.profile().workspace_m - Vec3(0.16, 0.07, 0.12)).norm(), 0, 1e-12);
  // Another one, weaker, in its place: the driver keeps to its limit although the gate knows the old one's.
  arm(0).plugged = 0;
  ASSERT_TRUE(connected(device, false));
  arm(0).max_force = 3.3;
  arm(0).plugged = 1;
  double strongest = 0;
  ASSERT_TRUE(serve(device, Vec3(7, 0, 0), [&](const DeviceReading&) {
    return (strongest = std::max(strongest, force(0).norm())) > 3.3 - 1e-9;
  }));
  EXPECT_LE(strongest, 3.3 + 1e-9);
  EXPECT_DOUBLE_EQ(device.profile().max_force_N, 7.9);
}

TEST_F(OpenHaptics, UnpluggedInContactAndPluggedInAgain) {
  OpenHapticsDevice device("Left Device");
  device.start();
  ASSERT_TRUE(serve(device, Vec3(0, 0, 1), [&](const DeviceReading&) { return force(0).y() > 0.9; }));
  arm(0).plugged = 0;
  ASSERT_TRUE(serve(device, Vec3(0, 0, 1), [&](const DeviceReading& r) { return !r.connected; }));
  EXPECT_EQ(force(0), Vec3(0, 0, 0));
  ASSERT_TRUE(serve(device, Vec3(0, 0, 1), [&](const DeviceReading&) {
    return device.remark().find("lost (HD_COMM_ERROR)") != std::string::npos ||
           device.remark().find("not there") != std::string::npos;
  }));
  EXPECT_EQ(force(0), Vec3(0, 0, 0));
  arm(0).plugged = 1;
  ASSERT_TRUE(serve(device, Vec3(0, 0, 1), [&](const DeviceReading& r) { return r.connected && force(0).y() > 0.9; }));
  EXPECT_EQ(device.remark(), "");
}

TEST_F(OpenHaptics, ASilentServoLeavesNoForceBehind) {
  OpenHapticsDevice device("Left Device");
  device.start();
  ASSERT_TRUE(serve(device, Vec3(1, 0, 0), [&](const DeviceReading&) { return force(0).x() > 0.99; }));
  EXPECT_TRUE(testing::wait_for([&] { return force(0) == Vec3(0, 0, 0); }));  // nobody writes any more
  EXPECT_TRUE(connected(device));
}

TEST_F(OpenHaptics, TwoByNameStayApartAndOneMayBeMissing) {
  OpenHapticsDevice left("Left Device"), right("Right Device"), third("Third Device");
  left.start();
  right.start();
  third.start();
  EXPECT_NE(third.remark().find("\"Third Device\" is not there"), std::string::npos) << third.remark();
  EXPECT_NE(third.remark().find("touch:"), std::string::npos);
  put(arm(0).p, 10, 0, 0);
  put(arm(1).p, -10, 0, 0);
  ASSERT_TRUE(serve(left, Vec3(1, 0, 0), [&](const DeviceReading& r) {
    const DeviceReading other = right.read();
    right.write(Vec3(-2, 0, 0), Vec3::Zero());
    return r.pose.p.x() > 0.009 && other.pose.p.x() < -0.009 && force(0).x() > 0.9 && force(1).x() < -1.9;
  }));
  EXPECT_FALSE(third.read().connected);
  // The loss of one is nothing to the other.
  arm(0).plugged = 0;
  ASSERT_TRUE(connected(left, false));
  EXPECT_TRUE(connected(right));
  set(2, "Third Device", 3);
  EXPECT_TRUE(connected(third));
}

TEST_F(OpenHaptics, TheSameArmTwiceGoesToOneHandOnly) {
  OpenHapticsDevice left("Left Device"), right("Left Device");
  left.start();
  right.start();
  EXPECT_TRUE(connected(left));
  EXPECT_FALSE(right.read().connected);
  EXPECT_NE(right.remark(), "");
}

TEST_F(OpenHaptics, UncalibratedEncodersMoveNothingAndPushNothing) {
  arm(0).calibration_state = 0x5002;  // the stylus has to go into the inkwell
  OpenHapticsDevice device("Left Device");
  device.start();
  EXPECT_FALSE(serve(
      device, Vec3(1, 0, 0), [&](const DeviceReading& r) { return r.connected || force(0).norm() > 0; },
      std::chrono::milliseconds(300)));
  arm(0).calibration_state = 0x5001;  // in the inkwell: the driver asks for the update
  EXPECT_TRUE(serve(device, Vec3(1, 0, 0), [&](const DeviceReading& r) { return r.connected && force(0).x() > 0.9; }));
  EXPECT_EQ(arm(0).calibration_state, 0x5000);
}

TEST_F(OpenHaptics, PosesThatCannotBeAreDropped) {
  OpenHapticsDevice device("Left Device");
  device.start();
  ASSERT_TRUE(connected(device));
  arm(0).p[0] = std::nan("");
  ASSERT_TRUE(connected(device, false));  // nothing new that could be true
  EXPECT_GT(device.refused(), 0);
  arm(0).p[0] = 1e9;
  EXPECT_FALSE(device.read().connected);
  arm(0).p[0] = 0;
  EXPECT_TRUE(connected(device));
}

TEST_F(OpenHaptics, WithoutTheLibraryItSaysHowToGetIt) {
  ::setenv("INSULA_LIBHD", "/nowhere/libHD.so", 1);
  OpenHapticsDevice device("Left Device");
  try {
    device.start();
    FAIL();
  } catch (const InputError& e) {
    EXPECT_NE(std::string(e.what()).find("/nowhere/libHD.so"), std::string::npos);
    EXPECT_NE(std::string(e.what()).find("install 3D Systems' OpenHaptics"), std::string::npos);
  }
  EXPECT_FALSE(device.read().connected);
}

TEST_F(OpenHaptics, ALibraryWithoutAFunctionIsRefused) {
  ::setenv("INSULA_LIBHD", INSULA_BINARY_DIR "/tests/stub_libspnav.so", 1);
  OpenHapticsDevice device("");
  EXPECT_THROW(device.start(), InputError);
}

}  // namespace
}  // namespace insula
