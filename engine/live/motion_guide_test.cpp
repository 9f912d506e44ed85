// SPDX-License-Identifier: GPL-3.0-or-later
// Targets of a motion: its turns and its buttons, and nothing that lies on the way between them.
#include "engine/live/motion_guide.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "core/registry/registry.h"

namespace insula {
namespace {

std::unique_ptr<Simulation> empty_scene() {
  Registry registry;
  register_builtin(registry);
  return std::move(load_simulation_text("<scene/>", "/s.xml", registry, 1).simulation);
}

void add(Motion& m, double t, Vec3 p, double roll = 0, bool button1 = false) {
  m.add(1, {t, {{p, from_rotation_vector(Vec3(0, 0, roll))}, button1, false}});
}

TEST(MotionGuide, KeepsCornersTurnsAndButtons) {
  const auto simulation = empty_scene();
  Motion m;
  // 40 mm along x, a pause, 30 mm along y with half a turn in its second half, then the button.
  for (int k = 0; k <= 40; ++k) add(m, 0.1 * k, Vec3(0.001 * k, 0, 0));
  add(m, 6, Vec3(0.04, 0, 0));
  for (int k = 1; k <= 30; ++k)
    add(m, 6 + 0.1 * k, Vec3(0.04, 0.001 * k, 0), k <= 15 ? 0 : (k - 15) * std::numbers::pi / 60);
  add(m, 9.5, Vec3(0.04, 0.03, 0), std::numbers::pi / 4, true);
  const auto poses = guide_poses(m, *simulation);
  ASSERT_GE(poses.size(), 4u);
  ASSERT_LE(poses.size(), 8u);
  EXPECT_EQ(poses.front().time_s, 0);
  EXPECT_TRUE(poses.back().sample.button1);
  double nearest_corner = 1;
  for (const GuidePose& p : poses) {
    EXPECT_EQ(p.hand, 1);
    nearest_corner = std::min(nearest_corner, (p.sample.pose.p - Vec3(0.04, 0, 0)).norm());
  }
  EXPECT_LT(nearest_corner, 0.0035);
}

TEST(MotionGuide, ATargetSaysWhatTheMotionAskedOfItsInstrument) {
  const auto simulation = empty_scene();
  Motion m;
  add(m, 0, Vec3::Zero());
  m.add({0, "exchange", "right hook"});
  m.add({0.5, "ask", "other load b"});
  m.add({0.5, "ask", "hook load a"});
  add(m, 1, Vec3(0.02, 0, 0), 0, true);
  const auto poses = guide_poses(m, *simulation);
  ASSERT_EQ(poses.size(), 2u);
  EXPECT_EQ(poses[1].tool, "hook");
  EXPECT_EQ(poses[0].command, "");
  EXPECT_EQ(poses[1].command, "load");
  EXPECT_EQ(poses[1].argument, "a");
}

TEST(MotionGuide, APlaceWhereNoButtonActsIsPassed) {
  const auto simulation = empty_scene();
  Motion m;
  add(m, 0, Vec3::Zero());
  add(m, 1, Vec3(0.03, 0, 0));     // a turn on the way
  add(m, 2, Vec3(0.03, 0.03, 0));  // the button comes next
  add(m, 2.1, Vec3(0.03, 0.03, 0), 0, true);
  add(m, 3, Vec3(0.06, 0.03, 0), 0, true);  // with the button on
  add(m, 3.1, Vec3(0.06, 0.03, 0));
  add(m, 4, Vec3(0.06, 0.06, 0));
  const auto poses = guide_poses(m, *simulation);
  ASSERT_GE(poses.size(), 5u);
  for (const GuidePose& p : poses) EXPECT_EQ(p.passes, p.time_s < 1.5 || p.time_s > 3.5) << p.time_s;
}

TEST(MotionGuide, ALongMotionHasABoundedNumberOfTargets) {
  const auto simulation = empty_scene();
  Motion m;
  for (int k = 0; k < 600; ++k) add(m, 0.05 * k, Vec3(0.02 * (k % 2), 1e-6 * k, 0));
  EXPECT_LE(guide_poses(m, *simulation).size(), 200u);
  EXPECT_TRUE(guide_poses(Motion(), *simulation).empty());
}

}  // namespace
}  // namespace insula
