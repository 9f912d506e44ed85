// SPDX-License-Identifier: GPL-3.0-or-later
// Contacts taken at the expected end of a step: a ball led about the edge of a box, in closed form of the discretised
// law.
#include <cmath>
#include <numbers>

#include "plugins/contact/contact_for_test.h"

namespace insula {
namespace {

using namespace test;

constexpr double stiffness = 400, pressed = 0.05e-3;  // N/m, m
const Vec3 edge(0.046875, 0.003,
                0);  // of the block, at the ball's y; a number that single precision holds, as the file's reader has it

TriMesh block() { return shapes::box(Vec3(-edge.x(), -0.05, -0.01), Vec3(edge.x(), 0.05, 0), 20); }

Vec3 around(double angle) { return {std::cos(angle), 0, std::sin(angle)}; }
/// The device at this angle about the edge: a ball that yields nowhere presses with stiffness times `pressed`, straight
/// away from the edge.
Pose device(double angle) { return {edge + (radius - pressed) * around(angle), Quat::Identity()}; }

/// Force on the hand at the end of each step while the device goes about the edge by 8 degrees a step.
std::vector<Vec3> led_about_the_edge(const std::string& linearized_at) {
  Bench b(test_tool_urdf(radius), block(), upright, fmt::format(R"(friction="0" linearized_at="{}")", linearized_at));
  std::vector<Vec3> out;
  if (!b.tool) return out;
  b.move_to({edge + 1.5 * radius * around(0.45 * std::numbers::pi), b.tool->home_pose().q});
  for (int i = -4; i < 10; ++i) {
    Pose at = device(0.45 * std::numbers::pi - std::max(0, i) * 8 * std::numbers::pi / 180);
    at.q = b.tool->home_pose().q;
    b.move_to(at);
    if (i >= 0) out.push_back(b.tool->hand_force().head<3>());
  }
  return out;
}

TEST(ContactLinearizedAt, TheEndFollowsAnEdgeAsTheLawSays) {
  const auto forces = led_about_the_edge("end");
  ASSERT_EQ(forces.size(), 10u);
  // The normal is that of the expected place, the device's with the push of the step before; the row then says n . (x -
  // edge) = radius.
  Vec3 push = pressed * around(0.45 * std::numbers::pi);
  for (int i = 0; i < 10; ++i) {
    const Vec3 at = device(0.45 * std::numbers::pi - i * 8 * std::numbers::pi / 180).p - edge;
    const Vec3 n = (at + push).normalized();
    push = (radius - n.dot(at)) * n;
    EXPECT_NEAR((forces[std::size_t(i)] - stiffness * push).norm(), 0, 1e-9 * stiffness * pressed) << i;
  }
}

TEST(ContactLinearizedAt, TheEndIsManyTimesNearerToTheTruthThanTheStart) {
  std::array<double, 2> worst{0, 0};
  for (const int end : {0, 1}) {
    const auto forces = led_about_the_edge(end ? "end" : "start");
    ASSERT_EQ(forces.size(), 10u);
    for (int i = 0; i < 10; ++i) {
      const Vec3 truth = stiffness * pressed * around(0.45 * std::numbers::pi - i * 8 * std::numbers::pi / 180);
      worst[std::size_t(end)] =
          std::max(worst[std::size_t(end)], (forces[std::size_t(i)] - truth).norm() / truth.norm());
    }
  }
  EXPECT_GT(worst[0], 0.1);
  EXPECT_LT(worst[1], 0.02);
}

// Where the ball will be nearest to the edge, half a step on and a step later, if it goes on as it did.
TEST(ContactLinearizedAtEnd, FollowsAnEdgeAsTheToolGoesOn) {
  Bench b(test_tool_urdf(radius), block(), upright, R"(friction="1e-9" linearized_at="end")");
  ASSERT_TRUE(b.tool);
  b.move_to({edge + 1.5 * radius * around(0.45 * std::numbers::pi), b.tool->home_pose().q});
  std::vector<ContactFrame> frames;
  Vec3 before = Vec3::Zero();
  for (int i = -4; i < 8; ++i) {
    Pose at = device(0.45 * std::numbers::pi - std::max(0, i) * 8 * std::numbers::pi / 180);
    at.q = b.tool->home_pose().q;
    b.move_to(at);
    const Contact::Pair& pair = b.contact->pairs()[0];
    const Vec3 now = pair.tool_a->link_pose(pair.link_a).p;
    if (i >= 1) {
      frames.clear();
      b.contact->predict_frames(0.5, frames);
      ASSERT_EQ(frames.size(), 1u) << i;
      for (const double steps : {0.5, 1.5}) {
        const Vec3 expected = (now + steps * (now - before) - edge).normalized();
        EXPECT_NEAR(((steps < 1 ? frames[0].ahead : frames[0].later) - expected).norm(), 0, 1e-9) << i;
      }
    }
    before = now;
  }
}

// In one step from the top to the side: what is felt is the side alone.
TEST(ContactLinearizedAt, OverAnEdgeTheNewFaceIsFeltInTheStepThatGetsThere) {
  for (const bool end : {false, true}) {
    Bench b(test_tool_urdf(radius), block(), upright,
            fmt::format(R"(friction="0" linearized_at="{}")", end ? "end" : "start"));
    ASSERT_TRUE(b.tool);
    Pose at = b.tool->home_pose();
    at.p = edge + Vec3(-0.4e-3, 0, radius - pressed);
    for (int i = 0; i < 4; ++i) b.move_to(at);
    EXPECT_NEAR((b.tool->hand_force().head<3>() - Vec3(0, 0, stiffness * pressed)).norm(), 0, 1e-12);
    at.p = edge + Vec3(radius - pressed, 0, -2e-3);
    b.move_to(at);
    const Vec3 f = b.tool->hand_force().head<3>();
    if (end) EXPECT_NEAR((f - Vec3(stiffness * pressed, 0, 0)).norm(), 0, 1e-12);
    else EXPECT_GT(f.z(), 2 * stiffness * pressed) << "the top, which is no longer there";
  }
}

TEST(ContactLinearizedAt, ResetLeadsBackToTheSameBits) {
  SceneFolder folder;
  auto s = soft_bench(folder, R"(<contact between="pad top left right" friction="0.3" linearized_at="end"/>)");
  ASSERT_TRUE(s);
  std::vector<std::uint64_t> hashes;
  for (const int run : {0, 1}) {
    s->reset();
    for (int i = 0; i < 50; ++i) {
      press(*s, i);
      s->step();
      if (run == 0) hashes.push_back(s->state_hash());
      else {
        ASSERT_EQ(s->state_hash(), hashes[std::size_t(i)]) << i;
      }
    }
  }
}

}  // namespace
}  // namespace insula
