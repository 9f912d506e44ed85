// SPDX-License-Identifier: GPL-3.0-or-later
// What all drivers share: nothing in the servo's calls allocates, forces keep to their limits, poses and forces belong
// together.
#include "haptic_server/devices/streamed_device.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <limits>
#include <thread>
#include <vector>

#include "core/testing/count_allocations.h"
#include "core/testing/held.h"
#include "haptic_server/problem_for_test.h"

namespace insula {
namespace {

/// A driver whose thread is the test.
struct Bare final : StreamedDevice {
  explicit Bare(const DeviceCalibration& c) : StreamedDevice(c) {
    profile_.max_torque_Nm = 0.1;
    limit(3.3, 0.1);
  }
  using StreamedDevice::deliver;
  using StreamedDevice::limit;
  using StreamedDevice::lost;
  using StreamedDevice::wanted;
};

TEST(StreamedDevice, TheServosCallsAllocateNothing) {
  Bare device{DeviceCalibration{}};
  DeviceSample s;
  const long before = allocations.load();
  double sum = 0;
  for (int k = 0; k < 1000; ++k) {
    s.pose.p.x() = 1e-4 * k;
    device.deliver(s);
    sum += device.read().pose.p.x();
    device.write(Vec3(1, 0, 0), Vec3::Zero());
    sum += device.wanted().force_N.x();
    if (k % 100 == 0) device.place(Pose(), Vec3::Zero(), Vec3::Zero());
  }
  EXPECT_EQ(allocations.load() - before, 0);
  EXPECT_GT(sum, 0);
}

TEST(StreamedDevice, PowerIsTheSameOnBothSides) {
  // Whatever the calibration: force times velocity in the scene is force times velocity at the device, times the scale.
  testing::Random random(8);
  for (int k = 0; k < 200; ++k) {
    DeviceCalibration c;
    c.axes = from_rotation_vector(random.vector(2)).toRotationMatrix();
    c.rest = {random.vector(0.1), from_rotation_vector(random.vector(1))};
    c.scale = 1 + 0.5 * random.next();
    Bare device(c);
    device.face(from_rotation_vector(random.vector(2)));
    device.place({random.vector(0.2), from_rotation_vector(random.vector(1))}, Vec3::Zero(), Vec3::Zero());
    DeviceSample s;
    s.pose = {random.vector(0.1), from_rotation_vector(random.vector(1))};
    s.v = random.vector(0.3);
    s.w = random.vector(3);
    s.has_w = true;
    device.deliver(s);
    const DeviceReading r = device.read();
    ASSERT_TRUE(r.connected);
    const Vec3 force = random.vector(1), torque = random.vector(0.05);
    device.write(force, torque);
    const DeviceForce f = device.wanted();
    ASSERT_TRUE(
        test::held("power of a real device, W", std::abs(force.dot(r.v) - c.scale * f.force_N.dot(s.v)), 1, 1e-12));
    ASSERT_TRUE(test::held("power of its torque, W", std::abs(torque.dot(r.w) - f.torque_Nm.dot(s.w)), 1, 1e-12));
    // A small turn of the device turns the tool about the axis that w says.
    const Quat small = from_rotation_vector(1e-4 * s.w);
    s.pose.q = small * s.pose.q;
    device.deliver(s);
    ASSERT_TRUE(test::held("a small turn of a device, rad",
                           (rotation_vector(device.read().pose.q * r.pose.q.conjugate()) - 1e-4 * r.w).norm(), 1,
                           1e-9));
  }
}

TEST(StreamedDevice, ForcesThatCannotBeAreNone) {
  Bare device{DeviceCalibration{}};
  const double nan = std::numeric_limits<double>::quiet_NaN();
  for (const Vec3& bad : {Vec3(nan, 0, 0), Vec3(0, std::numeric_limits<double>::infinity(), 0)}) {
    device.write(bad, Vec3::Zero());
    EXPECT_EQ(device.wanted().force_N, Vec3(0, 0, 0));
    device.write(Vec3::Zero(), bad);
    EXPECT_EQ(device.wanted().torque_Nm, Vec3(0, 0, 0));
  }
  device.write(Vec3(100, 0, 0), Vec3(0, 0, 9));
  EXPECT_NEAR(device.wanted().force_N.x(), 3.3, 1e-12);
  EXPECT_NEAR(device.wanted().torque_Nm.z(), 0.1, 1e-12);
  device.limit(nan, nan);
  device.write(Vec3(1, 0, 0), Vec3::Zero());
  EXPECT_EQ(device.wanted().force_N, Vec3(0, 0, 0));
}

TEST(StreamedDevice, AStallOfTheServoDoesNotEndInAStep) {
  Bare device{DeviceCalibration{}};
  const auto sleep_ms = [](int n) { std::this_thread::sleep_for(std::chrono::milliseconds(n)); };
  device.write(Vec3(1, 0, 0), Vec3::Zero());
  EXPECT_EQ(device.wanted().force_N.x(), 1);
  sleep_ms(60);
  EXPECT_EQ(device.wanted().force_N.x(), 0);
  double last = 0, steepest = 0;
  int calls = 0;
  for (; last < 1 && calls < 10000; ++calls) {
    device.write(Vec3(1, 0, 0), Vec3::Zero());
    const double f = device.wanted().force_N.x();
    steepest = std::max(steepest, f - last);
    last = f;
    sleep_ms(1);
  }
  EXPECT_EQ(last, 1);
  EXPECT_LE(steepest, 0.1 + 1e-9);  // 5 ms of 50 count at most
  EXPECT_GE(calls, 10);
}

TEST(StreamedDevice, VelocityOfTurningComesFromThePosesWhereItIsNotMeasured) {
  Bare device{DeviceCalibration{}};
  MonotonicClock clock;
  const std::int64_t start = clock.now_ns();
  double t = 0;
  std::vector<double> found;
  while (t < 0.3) {
    t = double(clock.now_ns() - start) * 1e-9;
    DeviceSample s;
    s.pose.q = from_rotation_vector(Vec3(0, 0, 2 * t));
    device.deliver(s);
    if (t > 0.1) found.push_back(device.read().w.z());
  }
  // A pose that was held up between being made and delivered is one of many.
  std::nth_element(found.begin(), found.begin() + std::ptrdiff_t(found.size() / 2), found.end());
  EXPECT_NEAR(found[found.size() / 2], 2, 0.1);
  device.lost();
  EXPECT_FALSE(device.read().connected);
}

}  // namespace
}  // namespace insula
