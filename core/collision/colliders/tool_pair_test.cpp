// SPDX-License-Identifier: GPL-3.0-or-later
// Tool against tool: balls, rods and blades, at rest and led past one another in one step.
#include "core/collision/colliders/tool_pair.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

namespace insula {
namespace {

constexpr double radius = 1e-3;

std::vector<RoundedPiece> pieces(std::vector<Vec3> core, double r) {
  ConvexPiece piece;
  piece.points = std::move(core);
  piece.radius = r;
  return {rounded(piece)};
}
const std::vector<RoundedPiece> ball = pieces({Vec3::Zero()}, radius);
const std::vector<RoundedPiece> rod = pieces({Vec3(0, 0, -0.02), Vec3(0, 0, 0.02)}, radius);

Pose at(double x, double y, double z = 0) { return {Vec3(x, y, z), Quat::Identity()}; }
const ToolMotion rests{at(0, 0), at(0, 0)};

std::vector<Proximity> detect(const std::vector<RoundedPiece>& a, const ToolMotion& motion,
                              const std::vector<RoundedPiece>& b, double collision_horizon = 0) {
  ToolContactSettings settings;
  settings.collision_horizon = collision_horizon;
  std::vector<Proximity> out;
  detect_tools(a, motion, b, rests, settings, out);
  return out;
}

/// Of the row when a ball has moved to `end`, m.
double gap_at(const Proximity& c, const ToolMotion& motion, const Pose& end) {
  return c.start_gap + c.normal.dot(end.p - motion.start.p);
}

TEST(ToolPair, AtRestHasItsGapAndNormal) {
  const auto blade =
      pieces({Vec3(-2e-4, -4e-3, 0), Vec3(2e-4, -4e-3, 0), Vec3(-2e-4, 4e-3, 0), Vec3(2e-4, 4e-3, 0),
              Vec3(-2e-4, -4e-3, 0.03), Vec3(2e-4, -4e-3, 0.03), Vec3(-2e-4, 4e-3, 0.03), Vec3(2e-4, 4e-3, 0.03)},
             0);
  std::vector<Proximity> out;
  const Pose beside = at(0.0018, 0);
  detect_tools(rod, rests, blade, {beside, beside}, {}, out);
  ASSERT_EQ(out.size(), 1u);
  EXPECT_NEAR(out[0].gap, 0.0018 - radius - 2e-4, 1e-9);
  EXPECT_NEAR((out[0].normal + Vec3::UnitX()).norm(), 0, 1e-9);
  EXPECT_NEAR((out[0].local - beside.apply(out[0].other_local)).norm(), 0, 1e-12);
  EXPECT_EQ(out[0].start_gap, out[0].gap);
}

// The plane of the start would stop it: it lies between the two balls, and the motion crosses it.
TEST(ToolPair, ABallThatPassesIsNotStopped) {
  const ToolMotion passes{at(-0.004, 0.0025), at(0.004, 0.0025)};
  const Vec3 n = passes.start.p.normalized();
  ASSERT_LT(passes.start.p.norm() - 2 * radius + n.dot(passes.end.p - passes.start.p), 0);
  for (const Proximity& c : detect(ball, passes, ball)) EXPECT_GE(gap_at(c, passes, passes.end), 0);
}

TEST(ToolPair, ABallThatGrazesAnotherOneIsFreeBehindIt) {
  const ToolMotion grazes{at(-0.004, 0.0018), at(0.004, 0.0018)};
  for (const Proximity& c : detect(ball, grazes, ball)) EXPECT_GE(gap_at(c, grazes, grazes.end), 0);
}

// It ends on the other ball: the row is the tangent plane where its free end is nearest to the surface.
TEST(ToolPair, ABallThatEndsOnAnotherOneHasTheNormalOfThere) {
  const ToolMotion lands{at(-0.003, 0.0017), at(0.0005, 0.0017)};
  const auto found = detect(ball, lands, ball);
  ASSERT_EQ(found.size(), 1u);
  const Proximity& c = found[0];
  EXPECT_NEAR(c.gap, 0, 1e-6);
  EXPECT_NEAR((c.normal - lands.end.p.normalized()).norm(), 0, 1e-3);
  EXPECT_NEAR(gap_at(c, lands, lands.end), c.normal.dot(lands.end.p) - 2 * radius, 1e-6);
  EXPECT_LT(gap_at(c, lands, lands.end), 0);
  // There, its centre is where the contact says.
  EXPECT_NEAR(gap_at(c, lands, {2 * radius * c.normal, Quat::Identity()}), 0, 1e-6);
}

TEST(ToolPair, ARodIsStoppedByTheRodThatItWouldPassThrough) {
  for (const double far : {0.002, 0.004, 0.008}) {
    ToolMotion crosses{at(-0.0025, 0), at(far, 0)};
    crosses.start.q = crosses.end.q = Quat(Eigen::AngleAxisd(0.5 * std::numbers::pi, Vec3::UnitX()));
    const auto found = detect(rod, crosses, rod);
    ASSERT_EQ(found.size(), 1u) << far;
    EXPECT_NEAR((found[0].normal + Vec3::UnitX()).norm(), 0, 1e-9);
    EXPECT_NEAR(gap_at(found[0], crosses, crosses.end), -far - 2 * radius, 1e-9);
  }
}

// A tool that presses keeps its contact where it is, and an overlap is undone by max_correction.
TEST(ToolPair, OverlapAtTheStartIsUndoneStepByStep) {
  const ToolMotion held{at(0.0005, 0), at(0.0005, 0)};
  const auto found = detect(ball, held, ball);
  ASSERT_EQ(found.size(), 1u);
  EXPECT_NEAR(found[0].gap, 0.0005 - 2 * radius, 1e-12);
  EXPECT_EQ(found[0].start_gap, -ToolContactSettings{}.max_correction);
  EXPECT_NEAR((found[0].normal - Vec3::UnitX()).norm(), 0, 1e-12);
}

// Until the next step, the haptic loop moves the tool on.
TEST(ToolPair, AContactSoonAfterTheStepIsTakenWhereItIsThen) {
  const ToolMotion comes{at(-0.0045, 0.0005), at(-0.0035, 0.0005)};
  EXPECT_TRUE(detect(ball, comes, ball).empty());
  const auto found = detect(ball, comes, ball, 2);
  ASSERT_EQ(found.size(), 1u);
  EXPECT_GT(gap_at(found[0], comes, comes.end), 0) << "not yet";
  const ToolMotion passes{at(-0.005, 0.0022), at(-0.002, 0.0022)};
  for (const Proximity& c : detect(ball, passes, ball, 2)) {
    EXPECT_GE(gap_at(c, passes, passes.end), 0);
    EXPECT_GE(gap_at(c, passes, at(0.001, 0.0022)), 0) << "nor later";
  }
}

}  // namespace
}  // namespace insula
