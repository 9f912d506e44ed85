// SPDX-License-Identifier: GPL-3.0-or-later
// The proposed neck of thirty generated arteries: it stands where the dome was joined, and no vessel is in the sac.
#include <gtest/gtest.h>

#include "branches_of_sac.h"
#include "generated_artery_for_test.h"
#include "import_parts.h"

namespace insula::artery {
namespace {

class GeneratedNeck : public testing::TestWithParam<test::GeneratedArtery> {};

/// Vertices of the found sac and of the true dome.
struct Counted {
  int sac = 0, sac_on_vessels = 0, dome = 0, missed = 0;
};
Counted counted(const Vessel& v, const test::GeneratedArtery& truth) {
  Counted n;
  for (std::size_t i = 0; i < v.region.size(); ++i) {
    const Vec3& p = v.wall.mesh.vertices[i];
    const std::string& region = v.regions[std::size_t(v.region[i])];
    const double off_vessels = truth.of_vessels(p);  // mm from their walls
    n.sac += region == "sac";
    n.sac_on_vessels += region == "sac" && off_vessels < 0.1;
    const bool of_dome = off_vessels > 0.6 && truth.of_dome(p) < 0.1;
    n.dome += of_dome;
    n.missed += of_dome && region != "sac" && region != "neck";
  }
  return n;
}

TEST_P(GeneratedNeck, StandsWhereTheDomeWasJoined) {
  const test::GeneratedArtery& truth = GetParam();
  const Surface surface = truth.surface();
  ASSERT_EQ(quality(surface.mesh).euler, 2);
  const Vessel v = vessel_of(surface, {});
  ASSERT_TRUE(v.neck);
  const Vec3 apart = v.neck->centre - truth.dome.root;
  const double up = apart.dot(truth.dome.axis), aside = (apart - up * truth.dome.axis).norm();
  const double angle = std::acos(std::min(1.0, v.neck->normal.dot(truth.dome.axis))) * 180 / std::numbers::pi;
  EXPECT_LT(angle, 22);
  EXPECT_LT(aside, 0.3);
  EXPECT_GT(up, -0.5);
  EXPECT_LT(up, 0.55 * (truth.dome.lift + 2) * truth.dome.half_height);
  // The true figure is that of the stem without its fillet and without what a flat dome adds to it.
  EXPECT_GT(v.neck->diameter, 0.95 * truth.dome.neck_diameter);
  EXPECT_LT(v.neck->diameter, 1.35 * truth.dome.neck_diameter);
  const Counted n = counted(v, truth);
  EXPECT_GT(n.sac, 25);
  EXPECT_EQ(n.sac_on_vessels, 0);
  EXPECT_TRUE(branches_of_sac(v).empty());
  // A neck that leaves much of the dome to the vessels is said to be unsure.
  if (neck_confidence(v.proposals) > 0.85) {
    EXPECT_LE(n.missed, 0.11 * n.dome);
  }
  EXPECT_LE(n.missed, 0.3 * n.dome);
}

INSTANTIATE_TEST_SUITE_P(Thirty, GeneratedNeck, testing::ValuesIn(test::generated_arteries()),
                         [](const auto& p) { return p.param.name; });

TEST(NeckProposals, AgreeOnAClearNeckMoreThanOnABlister) {
  double plain = 0, blister = 0;
  for (const test::GeneratedArtery& a : test::generated_arteries())
    if (a.name == "side_plain" || a.name == "blister") {
      const Vessel v = vessel_of(a.surface(), {});
      ASSERT_EQ(v.proposals.size(), 3u);
      (a.name == "blister" ? blister : plain) = neck_confidence(v.proposals);
    }
  EXPECT_GT(plain, 0.95);
  EXPECT_LT(blister, 0.85);
}

TEST(NeckProposals, AGivenNeckIsTakenAsSure) {
  const Surface surface = test::generated_arteries().front().surface();
  ImportOptions options;
  options.neck = vessel_of(surface, {}).proposals.front().plane;
  const Vessel v = vessel_of(surface, options);
  EXPECT_TRUE(v.proposals.empty());
  EXPECT_EQ(neck_confidence(v.proposals), 1);
}

/// A branch that leaves the dome itself. Every plane that parts the dome leaves the branch's opening beyond it.
TEST(NeckProposals, TheShortestLineIsTheNeckWhereABranchLeavesTheDome) {
  test::Dome dome;
  dome.neck_diameter = 3.4, dome.radius = 3.2, dome.half_height = 3.2, dome.lift = 0.2;
  test::GeneratedArtery a = test::on_fork("branch_of_the_dome", {}, dome, 0, 0);
  const Vec3 from = a.dome_centre() + Vec3(0, 1.4, 1.8);
  a.limbs.push_back(
      {"of_the_dome", smooth_curve({from, from + Vec3(0, 3, 4), from + Vec3(1, 5, 8)}, 0.5, 0.5, 0.4), false, true});
  const Vessel v = vessel_of(a.surface(), {});
  ASSERT_TRUE(v.neck);
  ASSERT_FALSE(v.proposals.empty());
  EXPECT_EQ(v.proposals.front().method, "shortest line");
  EXPECT_FALSE(v.proposals.front().planar);
  EXPECT_LT(neck_confidence(v.proposals), 0.85);
  EXPECT_EQ(branches_of_sac(v).size(), 1u);
  for (std::size_t t = 0; t < v.wall.patch.size(); ++t) {
    if (v.wall.patch[t] < 0) continue;
    for (const int i : v.wall.mesh.triangles[t]) EXPECT_EQ(v.regions[std::size_t(v.region[std::size_t(i)])], "ends");
  }
  EXPECT_GT(counted(v, a).sac, 25);
}

/// Both branches are as thin as two cells of the grid in which the paths are found.
TEST(GridCentrelines, RunAlongTheMiddleOfThinVessels) {
  test::Dome dome;
  dome.neck_diameter = 2.6, dome.radius = 2.4, dome.half_height = 2.6, dome.lift = 0.3;
  const test::GeneratedArtery a = test::on_fork("thin", {1.2, 0.45, 0.45, 75, 70, 18}, dome, 0, 0);
  const Vessel v = vessel_of(a.surface(), {});
  int points = 0;
  for (const NamedCurve& c : v.centrelines) {
    if (!c.name.starts_with("branch")) continue;
    const Curve& curve = c.curve;
    for (std::size_t k = 0; k + 1 < curve.size(); ++k) {  // the last one is the cap's middle
      const Vec3& p = curve.points[k];
      if ((p - a.dome.root).norm() < 4) continue;
      ++points;
      const double off_wall = -a.of_vessels(p);  // the true radius less what lies between the point and the true middle
      EXPECT_GT(off_wall, 0.7 * 0.42) << p.transpose();
      EXPECT_GT(curve.radius[k], 0.6 * 0.42);  // of the wall's triangles
      EXPECT_LT(curve.radius[k], 1.1 * 0.45);
    }
  }
  EXPECT_GT(points, 20);
}

}  // namespace
}  // namespace insula::artery
