// SPDX-License-Identifier: GPL-3.0-or-later
// The Force Dimension driver against a stub libdhd.so.
#include "haptic_server/devices/forcedimension.h"

#include "core/base/input_error.h"
#include "tests/devices/device_bench.h"

namespace insula {
namespace {

class ForceDimension : public testing::DeviceBench {};

TEST_F(ForceDimension, StreamsAndPushesInThePersonsAxes) {
  ForceDimensionDevice device("");
  device.start();
  put(arm(0).p, 0.01, 0.02, 0.03);  // to the person, right, up
  put(arm(0).v, 0, 0.1, 0);
  arm(0).buttons = 1;
  ASSERT_TRUE(serve(device, Vec3(1, 2, 3), [&](const DeviceReading& r) {
    return r.connected && r.button1 && (r.pose.p - Vec3(0.02, -0.01, 0.03)).norm() < 1e-12 &&
           (force(0) - Vec3(-2, 1, 3)).norm() < 1e-12;
  }));
  const DeviceReading r = device.read();
  EXPECT_NEAR((r.v - Vec3(0.1, 0, 0)).norm(), 0, 1e-12);
  EXPECT_FALSE(r.button2);
  device.stop();
  EXPECT_EQ(force(0), Vec3(0, 0, 0));
  EXPECT_EQ(arm(0).open, 0);
}

TEST_F(ForceDimension, KnowsItsModels) {
  ForceDimensionDevice omega("1001");
  omega.start();
  EXPECT_DOUBLE_EQ(omega.profile().max_force_N, 10);  // of 12: more is never asked of a hand
  EXPECT_DOUBLE_EQ(omega.profile().max_torque_Nm, 0);
  EXPECT_DOUBLE_EQ(omega.profile().apparent_mass_kg, 0.19);
  EXPECT_TRUE(omega.profile().gravity_compensated);
  arm(1).type = 104;
  ForceDimensionDevice sigma("1002");
  sigma.start();
  EXPECT_DOUBLE_EQ(sigma.profile().max_torque_Nm, 0.4);
  ASSERT_TRUE(testing::wait_for([&] {
    sigma.read();
    sigma.write(Vec3::Zero(), Vec3(0.1, 0, 0));
    return torque(1).y() > 0.09;
  }));
  arm(2).type = 4711;
  arm(2).plugged = 1;
  ForceDimensionDevice unknown("#2");
  unknown.start();
  EXPECT_DOUBLE_EQ(unknown.profile().max_force_N, 3.3);
}

TEST_F(ForceDimension, TwoWithoutNamesTakeOneEach) {
  ForceDimensionDevice left(""), right(""), none("");
  left.start();
  right.start();
  none.start();
  put(arm(0).p, 0, 0.01, 0);
  put(arm(1).p, 0, -0.01, 0);
  ASSERT_TRUE(serve(left, Vec3::Zero(),
                    [&](const DeviceReading& r) { return r.pose.p.x() > 0 && right.read().pose.p.x() < 0; }));
  EXPECT_FALSE(none.read().connected);
  EXPECT_NE(none.remark().find("is not there"), std::string::npos);
  left.stop();
  EXPECT_TRUE(connected(none));  // free again
}

TEST_F(ForceDimension, BySerialNumberAndByPosition) {
  ForceDimensionDevice right("1002"), left("#0"), missing("77");
  right.start();
  left.start();
  missing.start();
  put(arm(1).p, 0, 0.01, 0);
  ASSERT_TRUE(serve(right, Vec3::Zero(), [&](const DeviceReading& r) { return r.pose.p.x() > 0.009; }));
  EXPECT_TRUE(connected(left));
  EXPECT_FALSE(missing.read().connected);
  EXPECT_THROW(ForceDimensionDevice("omega"), InputError);
  EXPECT_THROW(ForceDimensionDevice("#"), InputError);
}

TEST_F(ForceDimension, UnpluggedInContactAndPluggedInAgain) {
  ForceDimensionDevice device("1001");
  device.start();
  ASSERT_TRUE(serve(device, Vec3(0, 0, 1), [&](const DeviceReading&) { return force(0).z() > 0.9; }));
  arm(0).plugged = 0;
  put(arm(0).force, 0, 0, 0);
  ASSERT_TRUE(connected(device, false));
  ASSERT_TRUE(testing::wait_for([&] { return !device.remark().empty(); }));
  arm(0).plugged = 1;
  ASSERT_TRUE(serve(device, Vec3(0, 0, 1), [&](const DeviceReading& r) { return r.connected && force(0).z() > 0.9; }));
  EXPECT_TRUE(testing::wait_for([&] { return force(0) == Vec3(0, 0, 0); }));  // nobody writes any more
  EXPECT_EQ(device.remark(), "");
}

TEST_F(ForceDimension, WithoutTheLibraryItSaysHowToGetIt) {
  ::setenv("INSULA_LIBDHD", "/nowhere/libdhd.so", 1);
  ForceDimensionDevice device("");
  EXPECT_THROW(device.start(), InputError);
}

}  // namespace
}  // namespace insula
