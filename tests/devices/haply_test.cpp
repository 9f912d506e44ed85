// SPDX-License-Identifier: GPL-3.0-or-later
// The Haply driver against a stand-in of its service.
#include "haptic_server/devices/haply.h"

#include "haptic_server/devices/make_device.h"
#include "tests/devices/device_bench.h"
#include "tests/devices/haply_stand_in.h"

namespace insula {
namespace {

using testing::HaplyStandIn;

class Haply : public testing::DeviceBench {
 protected:
  explicit Haply(bool session_id = true) : service(testing::two_arms(), session_id) {
    ::setenv("INSULA_HAPLY_URL", service.url().c_str(), 1);
  }
  HaplyStandIn service;
};

class OldHaply : public Haply {
 protected:
  OldHaply() : Haply(false) {}
};

TEST_F(Haply, EachHandGetsItsArmAndGrip) {
  HaplyDevice left("", 0), right("", 1);
  left.start();
  right.start();
  EXPECT_DOUBLE_EQ(left.profile().max_force_N, 4);
  service.change(1, [](auto& a) {
    a.p = Vec3(0.01, -0.12, 0.15);
    a.v = Vec3(0.1, 0, 0);
    a.b = true;
    a.q = from_rotation_vector(Vec3(0, 0, 0.5));
  });
  service.change(0, [](auto& a) {
    a.p = Vec3(-0.02, -0.12, 0.15);
    a.a = true;
  });
  ASSERT_TRUE(serve(left, Vec3(1, 2, 0.5), [&](const DeviceReading& l) {
    const DeviceReading r = right.read();
    right.write(Vec3(0, 0, -1), Vec3::Zero());
    return l.connected && r.connected && l.button2 && r.button1 &&
           (service.arm(1).force - Vec3(1, 2, 0.5)).norm() < 1e-4 &&
           (service.arm(0).force - Vec3(0, 0, -1)).norm() < 1e-4;
  }));
  const DeviceReading l = left.read(), r = right.read();
  EXPECT_NEAR((l.pose.p - Vec3(0.01, 0, 0)).norm(), 0, 1e-9);
  EXPECT_NEAR((r.pose.p - Vec3(-0.02, 0, 0)).norm(), 0, 1e-9);
  EXPECT_NEAR((rotation_vector(l.pose.q) - Vec3(0, 0, 0.5)).norm(), 0, 1e-9);
  EXPECT_NEAR((l.v - Vec3(0.1, 0, 0)).norm(), 0, 1e-9);
  EXPECT_EQ(service.introduced_as(), "org.insula:haptic_server");
  EXPECT_EQ(service.misunderstood(), 0);
  left.stop();
  EXPECT_TRUE(testing::wait_for([&] { return service.arm(1).force == Vec3(0, 0, 0); }));
}

TEST_F(OldHaply, IsSpokenToInItsOwnWords) {
  HaplyDevice device("04BA", 0);
  device.start();
  ASSERT_TRUE(serve(device, Vec3(0, 1, 0),
                    [&](const DeviceReading& r) { return r.connected && service.arm(0).force.y() > 0.9; }));
  EXPECT_EQ(service.misunderstood(), 0);
}

TEST_F(Haply, ByNameWithAGripOfItsOwn) {
  HaplyDevice device("04BA+61549", 0), missing("FFFF", 1);
  device.start();
  missing.start();
  service.change(1, [](auto& a) { a.a = true; });
  ASSERT_TRUE(serve(device, Vec3::Zero(), [](const DeviceReading& r) { return r.connected && r.button1; }));
  EXPECT_FALSE(missing.read().connected);
  EXPECT_NE(missing.remark().find("haply:FFFF: the Haply service has no such arm"), std::string::npos)
      << missing.remark();
}

TEST_F(Haply, UnpluggedInContactAndPluggedInAgain) {
  HaplyDevice device("04BA", 1);
  device.start();
  ASSERT_TRUE(serve(device, Vec3(1, 0, 0), [&](const DeviceReading&) { return service.arm(0).force.x() > 0.9; }));
  service.change(0, [](auto& a) { a.plugged = false; });
  ASSERT_TRUE(connected(device, false));
  service.change(0, [](auto& a) { a.plugged = true; });
  ASSERT_TRUE(connected(device));
  EXPECT_EQ(device.remark(), "");
  service.change(0, [](auto& a) { a.ready = false; });
  ASSERT_TRUE(connected(device, false));
  service.change(0, [](auto& a) { a.ready = true; });
  ASSERT_TRUE(connected(device));
}

TEST_F(Haply, TheServiceEndsAndComesBack) {
  HaplyDevice device("", 1);
  device.start();
  ASSERT_TRUE(connected(device));
  service.stop();
  ASSERT_TRUE(connected(device, false));
  ASSERT_TRUE(testing::wait_for([&] { return device.remark().find("no Haply service") != std::string::npos; }));
  service.start_again();
  EXPECT_TRUE(connected(device));
}

TEST_F(Haply, ASilentServoLeavesNoForceBehind) {
  HaplyDevice device("", 1);
  device.start();
  ASSERT_TRUE(serve(device, Vec3(1, 0, 0), [&](const DeviceReading&) { return service.arm(0).force.x() > 0.9; }));
  EXPECT_TRUE(testing::wait_for([&] { return service.arm(0).force == Vec3(0, 0, 0); }));
}

TEST_F(Haply, GarbageNeverMovesAHand) {
  HaplyDevice device("04BA", 1);
  device.start();
  ASSERT_TRUE(connected(device));
  const std::string head = R"({"inverse3":[{"device_id":"04BA","state":{"cursor_position":)";
  for (const std::string& garbage :
       {std::string("no JSON"), std::string("[1,2,3]"), std::string("{}"), head + R"({"x":1e999,"y":0,"z":0}}}]})",
        head + R"({"x":"1","y":0,"z":0}}}]})", head + R"({"x":0,"y":0}}}]})", head + R"([0,0,0]}}]})",
        head + R"({"x":50,"y":0,"z":0}}}]})", head + "null}}]}", std::string(100000, '[')}) {
    service.answer(garbage);
    const bool gone = serve(device, Vec3::Zero(), [&](const DeviceReading& r) {
      EXPECT_TRUE(!r.connected || r.pose.p.norm() < 1e-9) << garbage.substr(0, 100);
      return !r.connected;
    });
    ASSERT_TRUE(gone) << garbage.substr(0, 100);
    service.answer("");
    ASSERT_TRUE(connected(device)) << garbage.substr(0, 100);
  }
  EXPECT_GT(device.messages_refused() + device.refused(), 0);
}

TEST_F(Haply, WithoutAServiceItSaysHowToGetIt) {
  ::setenv("INSULA_HAPLY_URL", "http://localhost", 1);
  HaplyDevice device("", 0);
  device.start();
  EXPECT_NE(device.remark().find("\"http://localhost\" is no address like ws://localhost:10001"), std::string::npos)
      << device.remark();
  EXPECT_NE(device.remark().find("Haply Hub"), std::string::npos);
}

}  // namespace
}  // namespace insula
