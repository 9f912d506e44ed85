// SPDX-License-Identifier: GPL-3.0-or-later
// Devices that a scene names.
#include "engine/live/scene_devices.h"

#include <gtest/gtest.h>

#include <cstdlib>
#include <sstream>

#include "core/registry/registry.h"
#include "core/scene/loader.h"
#include "engine/command_line/commands.h"

namespace insula {
namespace {

TEST(SceneDevices, AreReadHandByHand) {
  Registry registry;
  register_builtin(registry);
  const auto scene = [&](const std::string& text) {
    return load_scene_text("<scene>" + text + "</scene>", "/tmp/scene.xml", registry);
  };
  EXPECT_EQ(scene_device(*scene("").scene, 0), "");
  const auto one = scene(R"(<devices left="touch:Left Device, mouse"/>)");
  ASSERT_TRUE(one.ok()) << one.diagnostics.format();
  EXPECT_EQ(scene_device(*one.scene, 0), "touch:Left Device, mouse");
  EXPECT_EQ(scene_device(*one.scene, 1), "");  // left to the haptic server
  Diagnostics none, two;
  check_scene_devices(*one.scene, none);
  EXPECT_TRUE(none.ok());
  check_scene_devices(*scene(R"(<devices left="tuch" right="mouse:3"/>)").scene, two);
  EXPECT_EQ(two.errors(), 2) << two.format();
}

TEST(SceneDevices, WhatCanNeverWorkIsSaidAtOnce) {
  ::setenv("INSULA_LIBHD", "/nowhere/libHD.so", 1);
  ::setenv("INSULA_HAPLY_URL", "ws://127.0.0.1:9", 1);
  EXPECT_NE(device_obstacle("touch").find("to get it: install 3D Systems' OpenHaptics"), std::string::npos);
  EXPECT_EQ(device_obstacle("touch, mouse"), "");
  EXPECT_EQ(device_obstacle("haply"), "");  // its service may come
  EXPECT_NE(device_obstacle("tuch").find("no device"), std::string::npos);
}

TEST(SceneDevices, TheCommandListsAndRefuses) {
  ::setenv("INSULA_LIBHD", "/nowhere/libHD.so", 1);
  ::setenv("INSULA_HAPLY_URL", "ws://127.0.0.1:9", 1);
  Registry registry;
  std::ostringstream out, err;
  EXPECT_EQ(cmd_devices({registry, out, err}, {}), 0);
  for (const char* kind : {"simulated", "mouse", "touch", "forcedimension", "haply", "spacemouse", "gamepad"})
    EXPECT_NE(("\n" + out.str()).find(std::string("\n") + kind + " "), std::string::npos) << kind;
  EXPECT_NE(out.str().find("not usable: /nowhere/libHD.so"), std::string::npos);
  DevicesOptions options;
  options.show = "tuch";
  EXPECT_EQ(cmd_devices({registry, out, err}, options), 2);
  EXPECT_NE(err.str().find("error: no device \"tuch\""), std::string::npos);
}

}  // namespace
}  // namespace insula
